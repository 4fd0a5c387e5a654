#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <vector>

#include "reports/report_formats.h"
#include "reports/words/describe.h"
#include "reports/words/display.h"
#include "reports/words/ledger.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr std::size_t message_limit = 4000;
constexpr std::size_t title_limit = 200;

std::string escaped(const std::string& text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) == special.npos) {
      out += c;
    } else {
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
  }
  return out;
}

std::string message(const std::string& text) {
  return escaped(cap(clean(text), message_limit), "%\r\n");
}

std::string property(const std::string& text) {
  return escaped(cap(one_line(text), title_limit), "%\r\n:,");
}

/// Errors first, then what is refuted most, then the rest in order.
double badness(const Test& test) {
  constexpr double first = std::numeric_limits<double>::infinity();
  if (test.verdict == Verdict::error) return first;
  if (test.verdict != Verdict::fail || test.channels.empty()) return 0;
  return -worst_channel(test).log10_p.value_or(0);
}

std::vector<const Test*> tests_that_are(const Record& record, Outcome kind) {
  std::vector<const Test*> tests = tests_of(record);
  std::erase_if(tests, [kind](const Test* test) { return outcome(*test) != kind; });
  std::stable_sort(tests.begin(), tests.end(),
                   [](const Test* a, const Test* b) { return badness(*a) > badness(*b); });
  return tests;
}

std::string annotation(const char* kind, const Test& test) {
  std::string where;
  if (!test.file.empty()) {
    where = fmt::format("file={},line={},", property(test.file), std::max(test.line, 1));
  }
  std::string text = plain_text(test);
  while (text.ends_with('\n')) text.pop_back();
  return fmt::format("::{} {}title={}::{}\n", kind, where,
                     property(fmt::format("{}: {}", verdict_text(test), test.id)),
                     message(text.empty() ? headline(test) : text));
}

std::string all_of(const char* kind, const std::vector<std::string>& lines) {
  const bool all = lines.size() <= most_annotations;
  const std::size_t shown = all ? lines.size() : most_annotations - 1;
  std::string out;
  for (std::size_t i = 0; i < shown; ++i) out += lines[i];
  if (!all) {
    out += fmt::format(
        "::{} title={}::{} more are not shown here; the summary of the job and the "
        "reports have all\n",
        kind, property("assay"), lines.size() - shown);
  }
  return out;
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
  for (const Test* test : tests_that_are(record, Outcome::failed)) {
    errors.push_back(annotation("error", *test));
  }
  std::vector<std::string> warnings;
  for (const Test* test : tests_that_are(record, Outcome::inconclusive)) {
    warnings.push_back(annotation("warning", *test));
  }
  return all_of("error", errors) + all_of("warning", warnings);
}

}  // namespace assay::reports
