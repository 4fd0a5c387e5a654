#include <fmt/format.h>

#include <algorithm>

#include "reports/viewer/charts.h"
#include "reports/viewer/html_parts.h"
#include "reports/viewer/html_table.h"
#include "reports/words/columns.h"
#include "reports/words/describe.h"
#include "reports/words/effect.h"
#include "reports/words/evidence.h"
#include "reports/words/number.h"
#include "reports/words/text.h"
#include "reports/words/summary.h"

namespace assay::reports {
namespace {

// A table of all tests is for finding one; its own section has the whole name.
std::string short_text(const std::string& text) { return escape_xml(shorten(one_line(text), 120)); }

std::string name_markup(const Test& test, TestPlace place) {
  std::string out = fmt::format("<a href=\"#{}\">{}</a>", anchor(place), short_text(test.name));
  if (!test.claim.empty() && test.claim != test.name)
    out += fmt::format("<br/><span class=\"claim\">{}</span>", short_text(test.claim));
  return "<span>" + out + "</span>";
}

std::string p_markup(const Test& test) {
  if (!is_evidence(test)) return {};
  const NamedP p = headline_p(test);
  if (!p.exists()) return {};
  const std::string value = escape_xml(p_text(p.p, p.log10_p));
  return p.name == "p" ? value
                       : fmt::format("<span>{}<br/><span class=\"muted\">{}</span></span>", value,
                                     escape_xml(p.name));
}

// A number that rests on a violated assumption is no effect; the record has it.
std::string effect_markup(const Test& test) {
  if (!is_evidence(test)) return {};
  const Effect effect = deciding_channel(test).effect;
  const std::string text = effect_text(effect);
  if (text.empty()) return {};
  return fmt::format(
      "<span><span class=\"whole\">{}</span><br/><span class=\"muted\">{}</span></span>",
      escape_xml(text), escape_xml(interval_name(effect)));
}

void add(HtmlTable& table, const Test& test, TestPlace place) {
  table.row({{badge(test), "verdict"},
             {name_markup(test, place), "name"},
             {effect_markup(test), "", effect_name(deciding_channel(test).effect)},
             {is_evidence(test) ? interval_sketch(test) : std::string()},
             {p_markup(test)},
             {count_text(observations(test)), "", grouped(observations(test))},
             cost_cell(total_cost(test))},
            outcome_style(outcome(test)));
}

bool needs_a_look(const Test& test) { return urgency(test) < 2; }

// Tests that need a look stand first, whichever suite they belong to.
void add_urgent(HtmlTable& table, const Record& record, Outcome kind, const char* heading) {
  bool first = true;
  for (std::size_t s = 0; s < record.suites.size(); ++s) {
    const std::vector<Test>& tests = record.suites[s].tests;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      if (outcome(tests[t]) != kind) continue;
      if (first) table.heading(heading, outcome_style(kind));
      first = false;
      add(table, tests[t], {s, t});
    }
  }
}

void add_rest(HtmlTable& table, const Record& record, std::size_t s) {
  const Suite& suite = record.suites[s];
  const std::vector<std::size_t> order = by_urgency(suite);
  if (order.empty() || needs_a_look(suite.tests[order.back()])) return;
  table.heading(fmt::format("<a href=\"#s{}\">{}</a>", s, escape_xml(one_line(suite.name))));
  for (const std::size_t t : order) {
    if (!needs_a_look(suite.tests[t])) add(table, suite.tests[t], {s, t});
  }
}

}  // namespace

std::vector<std::size_t> by_urgency(const Suite& suite) {
  std::vector<std::size_t> order;
  for (std::size_t t = 0; t < suite.tests.size(); ++t) order.push_back(t);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return urgency(suite.tests[a]) < urgency(suite.tests[b]);
  });
  return order;
}

std::string overview(const Record& record) {
  HtmlTable table({{"verdict"},
                   {"test and claim"},
                   {"effect [interval]"},
                   {"no effect (solid), detect (dashed)"},
                   {"p", true},
                   {"observations", true},
                   {"cost, CPU time", true}},
                  "cards");
  add_urgent(table, record, Outcome::failed, "Not ok");
  add_urgent(table, record, Outcome::inconclusive, "Undecided");
  for (std::size_t s = 0; s < record.suites.size(); ++s) add_rest(table, record, s);
  return table.finish();
}

}  // namespace assay::reports
