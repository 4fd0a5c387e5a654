#include "reports/formats/console_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/words/columns.h"
#include "reports/words/describe.h"
#include "reports/words/effect.h"
#include "reports/words/evidence.h"
#include "reports/words/number.h"
#include "reports/words/summary.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr int indent = 2;
constexpr int gap = 2;
constexpr int least_name = 30;

template <class Member>
int widest(const std::vector<TestRow>& rows, Member member) {
  int result = 0;
  for (const TestRow& row : rows) result = std::max(result, columns(row.*member));
  return result;
}

int with_gap(int width) { return width > 0 ? width + gap : 0; }

int name_room(const RowLayout& layout, int width) {
  return width - indent - with_gap(layout.verdict) - with_gap(layout.cost) -
         (layout.number_below ? 0 : with_gap(layout.number));
}

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

RowLayout layout_of(const std::vector<TestRow>& rows, int width) {
  RowLayout layout{.verdict = widest(rows, &TestRow::verdict),
                   .number = widest(rows, &TestRow::number),
                   .cost = widest(rows, &TestRow::cost)};
  if (name_room(layout, width) < least_name) layout.cost = 0;
  layout.number_below = name_room(layout, width) < least_name;
  layout.name = name_room(layout, width);
  return layout;
}

std::vector<std::string> row_lines(const TestRow& row, const RowLayout& layout) {
  const std::string margin(static_cast<std::size_t>(indent + with_gap(layout.verdict)), ' ');
  const std::vector<std::string> name = wrap(row.name, layout.name);
  std::string first = std::string(indent, ' ') + pad_right(row.verdict, with_gap(layout.verdict)) +
                      pad_right(name.front(), with_gap(layout.name));
  if (!layout.number_below) first += pad_right(row.number, with_gap(layout.number));
  if (layout.cost > 0) first += row.cost;
  std::vector<std::string> lines = {trimmed(first)};
  for (std::size_t i = 1; i < name.size(); ++i) lines.push_back(margin + name[i]);
  if (layout.number_below && !row.number.empty()) {
    for (const std::string& part : wrap(row.number, layout.name)) lines.push_back(margin + part);
  }
  return lines;
}

std::string common_confidence(const Suite& suite) {
  std::map<std::string, int> counts;
  for (const Test& test : suite.tests) {
    const Effect effect = deciding_channel(test).effect;
    if (is_evidence(test) && effect.estimate && !interval_text(effect).empty())
      ++counts[confidence_text(effect.confidence)];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? std::string() : most->first;
}

TestRow row_of(const Test& test, const std::string& common) {
  const Effect effect = deciding_channel(test).effect;
  std::string number = is_evidence(test) ? effect_text(effect) : std::string();
  if (!is_evidence(test)) {
    // The number rests on a violated assumption; the record has it.
  } else if (number.empty()) {
    number = headline_p(test).text();
  } else if (!interval_text(effect).empty() && confidence_text(effect.confidence) != common) {
    number += fmt::format(" at {}", confidence_text(effect.confidence));
  }
  return {.verdict = mark(outcome(test)) + " " + verdict_text(test),
          .name = one_line(test.name),
          .number = one_line(number),
          .cost = one_line(cost_text(total_cost(test)))};
}

}  // namespace assay::reports
