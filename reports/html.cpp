#include "reports/html.h"

#include <fmt/format.h>

#include "reports/charts.h"
#include "reports/columns.h"
#include "reports/describe.h"
#include "reports/html_parts.h"
#include "reports/number.h"
#include "reports/text.h"

namespace assay::reports {
namespace {

const char* overall_style(const Tally& counts) {
  if (counts.failed > 0) return "failed";
  if (counts.inconclusive > 0 || counts.passed == 0) return "inconclusive";
  return "passed";
}

std::string fact(const char* label, const std::string& value) {
  if (value.empty()) return {};
  return fmt::format("<span>{} <b>{}</b></span>\n", label, escape_xml(one_line(value)));
}

std::string about_the_run(const Record& record) {
  double alpha = 0;
  for (const Suite& suite : record.suites) alpha += suite.alpha;
  const Environment& where = record.environment;
  std::string out = "<div class=\"facts\">\n";
  out += fact("program", fmt::format("{} {}", record.tool.name, record.tool.version));
  out += fact("commit", record.tool.commit);
  out += fact("seed", fmt::format("{}", record.seed));
  out += fact(record.suites.size() > 1 ? "sum of the suites' alphas" : "alpha", human(alpha));
  out += fact("started", record.started);
  out += fact("took", duration(record.seconds));
  out += fact("threads", fmt::format("{}", where.threads));
  out += fact("rays traced with", where.isa);
  out += fact("processor", where.cpu);
  out += fact("compiler", where.compiler);
  out += "</div>\n";
  if (!record.note.empty()) out += fmt::format("<p>{}</p>\n", escape_xml(record.note));
  return out;
}

constexpr const char* reading_help =
    R"html(<details class="more"><summary>How to read this page</summary>
<dl>
<dt>pass</dt><dd>No evidence against the claim, and an effect as large as "detect" is excluded (where the test has one).</dd>
<dt>fail</dt><dd>The claim is rejected; over a whole suite of true claims that happens with probability alpha at most.</dd>
<dt>inconclusive</dt><dd>Neither: the budget ended before the data could decide.</dd>
<dt>invalid</dt><dd>An assumption of the test does not hold, so its numbers prove nothing.</dd>
<dt>error</dt><dd>The claim could not be tested: a value that is not finite, a crash, a time-out.</dd>
<dt>expected</dt><dd>A test is ok when its verdict is the expected one; a mutant is expected to fail.</dd>
<dt>effect</dt><dd>How far the estimator is from its claim, with an interval that holds the true value with the stated confidence.</dd>
</dl></details>
)html";

std::uint64_t observations(const Test& test) {
  std::uint64_t sum = 0;
  for (const Sample* sample : worst_samples(test)) sum += sample->secondaries;
  return sum;
}

std::string number_cell(const std::string& shown, const std::string& exact) {
  return fmt::format("<td class=\"number\" title=\"{}\">{}</td>", exact, shown);
}

// A table of all tests is for finding one; its own section has the whole name.
std::string overview_text(const std::string& text) { return shorten(one_line(text), 120); }

std::string overview_row(const Test& test, TestPlace place) {
  const Cost cost = total_cost(test);
  const std::string claim = test.claim.empty() || test.claim == test.name
                                ? std::string()
                                : fmt::format("<br/><span class=\"claim\">{}</span>",
                                              escape_xml(overview_text(test.claim)));
  return fmt::format(
             "<tr class=\"{}\"><td class=\"verdict\">{}</td><td class=\"name\"><a "
             "href=\"#{}\">{}</a>{}</td><td class=\"effect\">{}</td><td>{}</td>",
             outcome_style(outcome(test)), badge(test), anchor(place),
             escape_xml(overview_text(test.name)), claim, escape_xml(key_number(test)),
             interval_sketch(test)) +
         number_cell(count_text(observations(test)), grouped(observations(test))) +
         number_cell(count_text(rays(cost)), grouped(rays(cost))) +
         number_cell(duration(cost.seconds), round_trip(cost.seconds) + " s") + "</tr>\n";
}

std::string overview(const Record& record) {
  std::string out =
      "<div class=\"scroll\"><table>\n<thead><tr><th>verdict</th><th>test and claim</th>"
      "<th>effect [interval]</th><th>against zero, detect</th><th "
      "class=\"number\">observations</th>"
      "<th class=\"number\">rays</th><th class=\"number\">CPU time</th></tr></thead>\n";
  for (std::size_t s = 0; s < record.suites.size(); ++s) {
    const Suite& suite = record.suites[s];
    if (suite.tests.empty()) continue;
    out += fmt::format("<tbody>\n<tr><th colspan=\"7\"><a href=\"#s{}\">{}</a></th></tr>\n", s,
                       escape_xml(one_line(suite.name)));
    for (std::size_t t = 0; t < suite.tests.size(); ++t)
      out += overview_row(suite.tests[t], {s, t});
    out += "</tbody>\n";
  }
  return out + "</table></div>\n";
}

std::string head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<title>{}</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\"/>\n<style>{}</style>\n</head>\n",
      escape_xml(title), page_style);
}

}  // namespace

std::string anchor(TestPlace place) { return fmt::format("t{}-{}", place.suite, place.test); }

const char* outcome_style(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return "passed";
    case Outcome::failed:
      return "failed";
    case Outcome::inconclusive:
      return "inconclusive";
    case Outcome::skipped:
      break;
  }
  return "skipped";
}

std::string badge(const Test& test) {
  return fmt::format("<span class=\"badge\">{} {}</span>", mark(outcome(test)), verdict_text(test));
}

std::string figure(const std::string& chart, const std::string& caption) {
  if (chart.empty()) return {};
  return fmt::format("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", chart,
                     escape_xml(caption));
}

std::string html(const Record& record) {
  const Tally counts = tally(record);
  const std::string sentence = tally_sentence(counts);
  std::string out = head(fmt::format("Assay: {}", sentence));
  out += fmt::format(
      "<body>\n<h1 class=\"{}\">{}</h1>\n<p>{} passed, {} failed, {} inconclusive, {} "
      "skipped</p>\n",
      overall_style(counts), escape_xml(sentence), counts.passed, counts.failed,
      counts.inconclusive, counts.skipped);
  out += about_the_run(record);
  out += reading_help;
  out += "<p class=\"tools\"></p>\n";
  if (!record.suites.empty()) out += overview(record);
  for (std::size_t s = 0; s < record.suites.size(); ++s) out += suite_section(record, s);
  return out + fmt::format("<script>{}</script>\n</body>\n</html>\n", page_script);
}

}  // namespace assay::reports
