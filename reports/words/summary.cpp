#include "reports/words/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "reports/words/number.h"

namespace assay::reports {
namespace {

template <class Visitor>
void for_each_test(const Record& record, Visitor visit) {
  for (const Suite& suite : record.suites) {
    for (const Test& test : suite.tests) visit(test);
  }
}

std::string of_claims(int some, int total) {
  return fmt::format("{} of {}", some,
                     counted(static_cast<std::uint64_t>(total), "claim", "claims"));
}

/// The rank of a test in lists that begin with what needs a look: not ok, undecided, not run, ok.
int urgency(const Test& test) {
  constexpr int ranks[] = {3, 0, 1, 2};  // in the order of outcomes
  return ranks[static_cast<int>(outcome(test))];
}

}  // namespace

std::string mark(Outcome outcome) {
  constexpr const char* marks[] = {"✓", "✗", "?", "–"};
  return marks[static_cast<int>(outcome)];
}

std::string verdict_text(const Test& test) {
  const std::string verdict = to_string(test.verdict);
  if (test.verdict == Verdict::skipped) return verdict;
  if (test.verdict != test.expected)
    return test.expected == Verdict::pass
               ? verdict
               : fmt::format("{}, but {} expected", verdict, to_string(test.expected));
  // A verdict can be the expected one for the wrong reason; the message tells it.
  if (!test.ok) return verdict + ", yet not ok";
  return test.expected == Verdict::pass ? verdict : verdict + " (as expected)";
}

std::string tally_sentence(const Tally& tally) {
  const int total = tally.passed + tally.failed + tally.inconclusive + tally.skipped;
  if (total == 0) return "No claim was tested";
  if (tally.failed > 0) return of_claims(tally.failed, total) + " broken";
  if (tally.inconclusive > 0)
    return of_claims(tally.inconclusive, total) + " undecided, none broken";
  if (total == 1)
    return tally.skipped > 0 ? "The claim was not tested" : "The claim is as it should be";
  if (tally.skipped == total) return fmt::format("None of {} claims was tested", total);
  if (tally.skipped > 0)
    return fmt::format("{} as they should be, {} not tested", of_claims(tally.passed, total),
                       tally.skipped);
  return fmt::format("All {} claims are as they should be", total);
}

std::string verdict_counts(const Record& record) {
  // By urgency, the plain pass before what was expected to fail, then by their words.
  std::map<std::tuple<int, bool, std::string>, int> counts;
  for_each_test(record, [&](const Test& test) {
    ++counts[{urgency(test), test.verdict != Verdict::pass, verdict_text(test)}];
  });
  std::string out;
  for (const auto& [key, count] : counts)
    out += fmt::format("{}{}\u00A0{}", out.empty() ? "" : "; ", count, std::get<2>(key));
  return out;
}

std::string error_rates(const Record& record) {
  double alpha = 0, beta = 0;
  bool planned = false;
  for (const Suite& suite : record.suites) {
    if (suite.tests.empty()) continue;
    alpha += suite.alpha;
    beta = std::max(beta, suite.beta);
    for (const Test& test : suite.tests) planned = planned || test.detect.has_value();
  }
  if (!(alpha > 0)) return {};
  std::string text = fmt::format(
      "If every claim were true, some test would fail by chance with probability {} at most.",
      human(std::min(alpha, 1.0)));
  if (planned && beta > 0)
    text += fmt::format(
        " A claim that is off by its \"detect\" or more passes with probability {} at most.",
        human(beta));
  return text;
}

std::string false_alarms(double alpha) {
  if (!(alpha > 0)) return {};
  if (alpha >= 1) return "False alarms: in any run, as the suites' alphas add up to 1 or more.";
  // The fewest runs, a power of ten, of which a whole number is meant; two digits are enough.
  double runs = 100;
  const auto whole = [&] { return std::abs(alpha * runs - std::round(alpha * runs)) < 1e-6; };
  while (alpha * runs < 1 || (!whole() && alpha * runs < 10)) runs *= 10;
  const double some = whole() ? std::round(alpha * runs) : std::ceil(alpha * runs);
  return fmt::format("False alarms: at most {:.0f} run{} in {}.", some, some == 1 ? "" : "s",
                     in_commas(runs));
}

std::string false_alarms(const Record& record) {
  double alpha = 0;
  for (const Suite& suite : record.suites) alpha += suite.tests.empty() ? 0 : suite.alpha;
  return false_alarms(alpha);
}

}  // namespace assay::reports
