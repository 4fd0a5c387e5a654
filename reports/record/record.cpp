#include "reports/record/record.h"

#include <map>
#include <span>
#include <tuple>

namespace assay::reports {
namespace {

/// Draws that samples share are counted once, as far as the longest reaches.
Cost cost_of(std::span<const Test> tests) {
  using Draws = std::tuple<std::string, std::string, std::string, std::uint64_t>;
  std::map<Draws, const Sample*> longest;
  for (const Test& test : tests) {
    for (const Sample& each : test.samples) {
      const Sample*& known = longest[{each.plugin, each.parameters, each.stream, each.primaries}];
      if (known == nullptr || each.secondaries >= known->secondaries) known = &each;
    }
  }
  Cost sum;
  for (const auto& [draws, sample] : longest) {
    sum.camera_rays += sample->cost.camera_rays;
    sum.closest_hit_rays += sample->cost.closest_hit_rays;
    sum.shadow_rays += sample->cost.shadow_rays;
    sum.samples += sample->cost.samples;
    sum.seconds += sample->cost.seconds;
  }
  return sum;
}

}  // namespace

bool is_evidence(const Test& test) {
  return test.verdict != Verdict::invalid && test.verdict != Verdict::error;
}

Standing standing(const Test& test) {
  if (test.verdict == Verdict::skipped) return Standing::not_run;
  if (test.ok) return test.expected == Verdict::pass ? Standing::holds : Standing::caught;
  if (test.verdict == Verdict::inconclusive) return Standing::undecided;
  return is_evidence(test) ? Standing::broken : Standing::no_verdict;
}

std::vector<const Test*> tests_of(const Record& record) {
  std::vector<const Test*> tests;
  for (const Suite& suite : record.suites) {
    for (const Test& test : suite.tests) tests.push_back(&test);
  }
  return tests;
}

int alarms(const Ledger& ledger) {
  return static_cast<int>(std::ranges::count(ledger.series, true, &LedgerSeries::alarm));
}

Cost total_cost(const Test& test) { return cost_of(std::span(&test, 1)); }

Cost total_cost(const Suite& suite) { return cost_of(suite.tests); }

}  // namespace assay::reports
