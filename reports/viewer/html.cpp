#include "reports/viewer/html.h"

#include <fmt/format.h>

#include "reports/formats/ledger.h"
#include "reports/record/statements.h"
#include "reports/viewer/html_parts.h"
#include "reports/words/describe.h"
#include "reports/words/number.h"
#include "reports/words/summary.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

const char* overall_style(const Record& record, const Tally& counts) {
  if (counts.failed > 0 || alarms(record.ledger) > 0) return "failed";
  if (counts.inconclusive > 0 || counts.passed == 0) return "inconclusive";
  return "passed";
}

std::string fact(const char* label, const std::string& value) {
  if (value.empty()) return {};
  return fmt::format("<span>{} <b>{}</b></span>\n", label, escape_xml(one_line(value)));
}

bool traced_rays(const Record& record) {
  for (const Suite& suite : record.suites) {
    for (const EstimatorSummary& estimator : suite.estimators) {
      if (rays(estimator.cost) > 0) return true;
    }
    for (const Test& test : suite.tests) {
      if (rays(total_cost(test)) > 0) return true;
    }
  }
  return false;
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
  if (traced_rays(record)) out += fact("rays traced with", where.isa);
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
<dt>as expected</dt><dd>A mutant is a deliberately broken estimator: its claim is expected to fail, and the test is ok when it does.</dd>
<dt>effect</dt><dd>How far the estimator is from its claim. Ratios are shown as per cent near one, else as factors (×0.07).</dd>
<dt>interval</dt><dd>Holds the true effect with the confidence printed beside it. The interval shown is the one that the verdict rests on. A fail: at one minus the test's share of alpha, and it leaves out everything that is claimed or allowed. A pass with "detect", or of a proof (&lt;, &gt;, within): at one minus twice the test's share of beta, and it leaves out everything that must not pass. Where sampling went in looks, it holds at whichever look sampling stopped. Of an image it is of the size of the difference over all pixels, and may begin at 0 where a fail rests on the sum that differs most.</dd>
<dt>assumption</dt><dd>What the test takes for granted about the data, as measured. Green: it holds. Amber: it does not hold by itself, and the method chosen allows for it. Red: the test is invalid. A level factor says how much more often than its level one tail of the test errs because the data are skewed; 1 is exact.</dd>
<dt>look</dt><dd>Sampling stops as soon as a claim is decided. Each look at the data has levels of its own, such that all looks together keep the test's alpha and beta.</dd>
<dt>p</dt><dd>Of the claim, unless another name stands below it. The claims with &lt;, &gt; and within are proofs: their verdict rests on p(contrary), the p-value of the contrary of the claim.</dd>
</dl></details>
)html";

}  // namespace

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<title>{}</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\"/>\n<style>{}</style>\n</head>\n",
      escape_xml(title), page_style);
}

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
  const std::string words =
      caption.empty() ? "" : fmt::format("<figcaption>{}</figcaption>\n", escape_xml(caption));
  return fmt::format("<figure>\n<div class=\"scroll\">{}</div>{}</figure>\n", chart, words);
}

std::string html(const Record& record) {
  const Tally counts = tally(record);
  const std::string alarm = alarm_count(record);
  const std::string sentence = tally_sentence(counts) + (alarm.empty() ? "" : "; " + alarm);
  std::string out = page_head(fmt::format("Assay: {}", sentence));
  out += fmt::format("<body>\n<h1 class=\"{}\">{}</h1>\n<p>{}</p>\n<p>{}</p>\n",
                     overall_style(record, counts), escape_xml(sentence),
                     escape_xml(verdict_counts(record)), escape_xml(error_rates(record)));
  out += statements_section(record);
  if (statement_count(record) > 0) out += "<h2>Tests</h2>\n";
  out += about_the_run(record);
  out += reading_help;
  out += "<p class=\"tools\"></p>\n";
  if (!record.suites.empty()) out += overview(record);
  out += ledger_section(record.ledger);
  for (std::size_t s = 0; s < record.suites.size(); ++s) out += suite_section(record, s);
  return out + fmt::format("<script>{}</script>\n</body>\n</html>\n", page_script);
}

}  // namespace assay::reports
