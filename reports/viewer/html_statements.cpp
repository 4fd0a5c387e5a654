#include <fmt/format.h>

#include "reports/viewer/html_parts.h"
#include "reports/viewer/html_table.h"
#include "reports/words/statement_text.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr std::size_t shown = 3;

std::string words(const std::string& text) { return escape_xml(one_line(text)); }

std::string witness_markup(const Record& record, std::size_t s, const Witness& witness) {
  const std::string name =
      witness.test
          ? fmt::format("<a href=\"#{}\">{}</a>", anchor({s, *witness.test}), words(witness.name))
          : words(witness.name);
  return fmt::format("<li>{}<br/><span class=\"muted\">{}</span></li>\n", name,
                     words(finding(record.suites[s], witness)));
}

/// A few tests, and the rest of them behind a click.
std::string list_markup(const Record& record, std::size_t s,
                        const std::vector<std::string>& names) {
  const std::vector<Witness> all = witnesses(record.suites[s], names);
  const std::size_t first = all.size() == shown + 1 ? all.size() : std::min(all.size(), shown);
  std::string out = "<ul class=\"witnesses\">\n";
  for (std::size_t i = 0; i < first; ++i) out += witness_markup(record, s, all[i]);
  out += "</ul>\n";
  if (first == all.size()) return out;
  out += fmt::format("<details><summary>{} more tests</summary><ul class=\"witnesses\">\n",
                     all.size() - first);
  for (std::size_t i = first; i < all.size(); ++i) out += witness_markup(record, s, all[i]);
  return out + "</ul></details>\n";
}

std::string tests_markup(const Record& record, std::size_t s, const Statement& statement) {
  const bool both = !statement.holds.empty() && !statement.fails.empty();
  std::string out;
  if (both) out += "<b>it holds</b>\n";
  if (!statement.holds.empty()) out += list_markup(record, s, statement.holds);
  if (both) out += "<b>it does not</b>\n";
  if (!statement.fails.empty()) out += list_markup(record, s, statement.fails);
  return "<div>" + out + "</div>";
}

const char* style_of(Answer answer) {
  switch (answer) {
    case Answer::yes:
      return "passed";
    case Answer::open:
      return "inconclusive";
    case Answer::contradicted:
      return "failed";
    case Answer::only_if:
    case Answer::no:
      break;
  }
  return "answered";
}

void add(HtmlTable& table, const Record& record, std::size_t s, const Statement& statement) {
  const Answer given = answer(record.suites[s], statement);
  const std::string condition =
      given == Answer::only_if ? "<br/>" + words(statement.condition) : std::string();
  table.row({{fmt::format("<span class=\"statement\">{}<br/><span class=\"muted\">{}</span></span>",
                          words(statement.text), words(statement.source)),
              "name"},
             {fmt::format("<span><span class=\"badge\">{}</span>{}</span>",
                          words(answer_text(given)), condition),
              "answer"},
             {tests_markup(record, s, statement)}},
            style_of(given));
}

/// Statements that need a look stand first, whichever suite they belong to.
void add_with(HtmlTable& table, const Record& record, Answer wanted, const char* heading) {
  bool first = true;
  for (std::size_t s = 0; s < record.suites.size(); ++s) {
    for (const Statement& statement : record.suites[s].statements) {
      const Answer given = answer(record.suites[s], statement);
      if (given != wanted) continue;
      if (first) table.heading(heading, style_of(given));
      first = false;
      add(table, record, s, statement);
    }
  }
}

void add_answered(HtmlTable& table, const Record& record, std::size_t s) {
  const Suite& suite = record.suites[s];
  bool first = true;
  for (const Statement& statement : suite.statements) {
    const Answer given = answer(suite, statement);
    if (given == Answer::open || given == Answer::contradicted) continue;
    if (first) table.heading(fmt::format("<a href=\"#s{}\">{}</a>", s, words(suite.name)));
    first = false;
    add(table, record, s, statement);
  }
}

}  // namespace

std::string statements_section(const Record& record) {
  if (statement_count(record) == 0) return {};
  HtmlTable table({{"statement"}, {"answer"}, {"tests that answer it: effect [interval]"}},
                  "cards statements");
  add_with(table, record, Answer::contradicted, "Contradicted");
  add_with(table, record, Answer::open, "Open");
  for (std::size_t s = 0; s < record.suites.size(); ++s) add_answered(table, record, s);
  return fmt::format(
      "<h2 class=\"first\">Statements</h2>\n<p>{}</p>\n{}<p class=\"muted\">{}</p>\n",
      words(statement_totals(record)), table.finish(), escape_xml(statement_legend));
}

}  // namespace assay::reports
