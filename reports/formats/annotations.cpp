#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "reports/report_formats.h"
#include "reports/words/describe.h"
#include "reports/words/ledger.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr std::size_t message_limit = 4000;
constexpr std::size_t title_limit = 200;

constexpr Form forms[] = {{'%', "%25"}, {'\r', "%0D"}, {'\n', "%0A"}, {':', "%3A"}, {',', "%2C"}};

std::string message(const std::string& text) {
  return escape(cap(clean(text), message_limit), std::span(forms).first<3>());
}

std::string property(const std::string& text) {
  return escape(cap(one_line(text), title_limit), forms);
}

/// Errors first, then what is refuted most, then the rest in order.
double badness(const Test& test) {
  constexpr double first = std::numeric_limits<double>::infinity();
  if (test.verdict == Verdict::error) return first;
  if (test.verdict != Verdict::fail || test.channels.empty()) return 0;
  return -worst_channel(test).log10_p.value_or(0);
}

std::string annotation(const char* kind, const Test& test) {
  std::string where;
  if (!test.file.empty())
    where = fmt::format("file={},line={},", property(test.file), std::max(test.line, 1));
  std::string text = plain_text(test);
  while (text.ends_with('\n')) text.pop_back();
  return fmt::format("::{} {}title={}::{}\n", kind, where,
                     property(fmt::format("{}: {}", verdict_text(test), test.id)),
                     message(text.empty() ? headline(test) : text));
}

std::string all_of(const char* kind, std::vector<std::string> lines) {
  if (const std::size_t count = lines.size(); count > most_annotations) {
    lines.resize(most_annotations - 1);
    lines.push_back(fmt::format(
        "::{} title=assay::{} more are not shown here; the summary of the job and the reports "
        "have all\n",
        kind, count - lines.size()));
  }
  return fmt::format("{}", fmt::join(lines, ""));
}

}  // namespace

std::string annotations(const Record& record) {
  std::vector<std::string> errors;
  for (const LedgerSeries& series : record.ledger.series) {
    if (!series.alarm) continue;
    errors.push_back(fmt::format("::error title={}::{}\n",
                                 property("alarm of the ledger: " + series.test),
                                 message(alarm_sentence(series))));
  }
  std::vector<std::string> warnings;
  std::vector<const Test*> tests = tests_of(record);
  std::ranges::stable_sort(tests, {}, [](const Test* test) { return -badness(*test); });
  for (const Test* test : tests) {
    const Standing how = standing(*test);
    if (is_failed(how)) errors.push_back(annotation("error", *test));
    if (how == Standing::undecided) warnings.push_back(annotation("warning", *test));
  }
  return all_of("error", errors) + all_of("warning", warnings);
}

}  // namespace assay::reports
