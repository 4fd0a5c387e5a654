#include "reports/record/record.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace assay::reports {
namespace {

/// Draws that samples share are counted once, as far as the longest reaches.
class Draws {
 public:
  void add(const Sample& source) {
    Longest& longest =
        longest_[{source.plugin, source.parameters, source.stream, source.primaries}];
    if (source.secondaries >= longest.secondaries) longest = {source.secondaries, source.cost};
  }

  Cost total() const {
    Cost sum;
    for (const auto& [draws, longest] : longest_) {
      sum.camera_rays += longest.cost.camera_rays;
      sum.closest_hit_rays += longest.cost.closest_hit_rays;
      sum.shadow_rays += longest.cost.shadow_rays;
      sum.samples += longest.cost.samples;
      sum.seconds += longest.cost.seconds;
    }
    return sum;
  }

 private:
  struct Longest {
    std::uint64_t secondaries = 0;
    Cost cost;
  };
  std::map<std::tuple<std::string, std::string, std::string, std::uint64_t>, Longest> longest_;
};

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

Cost total_cost(const Test& test) {
  Draws draws;
  for (const Sample& sample : test.samples) draws.add(sample);
  return draws.total();
}

Cost total_cost(const Suite& suite) {
  Draws draws;
  for (const Test& test : suite.tests) {
    for (const Sample& sample : test.samples) draws.add(sample);
  }
  return draws.total();
}

}  // namespace assay::reports
