#include "harness/command/tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/command/describe.h"
#include "harness/language/laws.h"
#include "harness/language/quantities.h"
#include "harness/theta/gate.h"
#include "harness/theta/methods.h"
#include "reports/report_formats.h"

namespace assay::harness {
namespace {

constexpr std::size_t width = 80;

const char* kept_text(Keeps keeps) {
  constexpr const char* texts[] = {"four moments of a channel",
                                   "the values of a channel",
                                   "the values of all channels together",
                                   "counts in the cells of the density",
                                   "eight moments of a channel",
                                   "moments of values and costs together",
                                   "moments of the channels' summed variances",
                                   "values and CPU times of 32 replicates",
                                   "whole images"};
  return texts[static_cast<int>(keeps)];
}

/// A sentence for each property that a user may have to know.
std::string page_of(const MethodRow& row) {
  std::string page;
  const auto say = [&](bool holds, const std::string& sentence) {
    if (holds) page += wrapped(sentence, width, 2);
  };
  say(true, fmt::format("Force it by `test: {0}` in a suite, or by `--test {0}`.", row.name));
  say(true, fmt::format("It keeps {}.", kept_text(row.keeps)));
  say(row.is.exact, "Its level holds at every sample size.");
  say(!row.is.exact, "Its level is asymptotic; gates refuse data of too unusual a shape.");
  say(row.is.in_range, "The channel must declare the range of its values.");
  say(row.is.of_observations, "The moments of an earlier run are not enough for it.");
  say(row.is.of_batches, "It takes means of consecutive observations for independent.");
  say(row.is.corrects_skewness, "It estimates the skewness from the data.");
  say(row.is.of_normal_values, "It takes the values for nearly normal.");
  say(row.is.of_distinct_values, "Coarsely rounded values are refused.");
  say(row.is.over_looks == stats::LookLaw::anytime_valid, "Its p-value is valid at every look.");
  return page;
}

Table methods() {
  Table table{"methods", "a method", {}};
  for (const MethodRow& row : method_table()) {
    table.rows.push_back({row.name, row.summary, page_of(row)});
  }
  return table;
}

Table quantity_table() {
  Table table{"quantities", "a quantity", {}};
  for (const QuantityRow& row : quantities()) {
    std::string page = wrapped(fmt::format("Claim: {}", row.example), width, 2);
    if (row.of_a_sampler) page += "  It is about a sampler of an estimator.\n";
    if (row.over_all_channels) page += "  It is over all channels of an estimator.\n";
    table.rows.push_back({row.word, row.summary, page});
  }
  return table;
}

Table law_table() {
  Table table{"laws", "a law", {}};
  for (const LawInformation& law : laws()) {
    std::string page = fmt::format("  Claim: distribution(a) == {}\n", signature(law));
    for (const LawParameter& parameter : law.parameters) {
      if (parameter.positive) page += fmt::format("  `{}` is above 0.\n", parameter.name);
    }
    table.rows.push_back({law.name, signature(law), page});
  }
  return table;
}

Table gate_table() {
  Table table{"gates", "a gate", {}};
  for (const GateKind& gate : gate_kinds()) {
    const std::string red = fmt::format(fmt::runtime(gate.sentence), "VALUE", "LIMIT");
    std::string page = "  A red gate makes the test invalid, unless `test` forces the method.\n";
    if (gate.heavy_tail) page += "  More observations may only show more of the tail.\n";
    table.rows.push_back({gate.name, red, page});
  }
  return table;
}

Table report_table() {
  Table table{"reports", "a report", {}};
  for (const reports::ReportFormat& format : reports::report_formats()) {
    table.rows.push_back(
        {format.kind, format.summary,
         fmt::format("  Write it by `--report {}=FILE.{}`.\n", format.kind, format.ending)});
  }
  return table;
}

}  // namespace

const std::vector<Table>& tables() {
  static const std::vector<Table> all{methods(), quantity_table(), law_table(), gate_table(),
                                      report_table()};
  return all;
}

std::string text_of(const Table& table) {
  std::size_t longest = 0;
  for (const TableRow& row : table.rows) longest = std::max(longest, row.name.size());
  std::string text;
  for (const TableRow& row : table.rows) {
    const std::string lines = wrapped(row.summary, width, longest + 2);
    text += fmt::format("{:<{}}  {}", row.name, longest, lines.substr(longest + 2));
  }
  return text;
}

std::string pages_of(const std::string& name) {
  std::string text;
  for (const Table& table : tables()) {
    for (const TableRow& row : table.rows) {
      if (row.name != name) continue;
      text += fmt::format("{}{}, {}\n{}{}", text.empty() ? "" : "\n", row.name, table.singular,
                          wrapped(row.summary, width, 2), row.page);
    }
  }
  return text;
}

}  // namespace assay::harness
