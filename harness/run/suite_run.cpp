#include "harness/run/suite_run.h"

#include <algorithm>

namespace assay::harness {

std::uint64_t shown_by(const Picture& picture, const SuiteRun& run) {
  if (picture.own) return *picture.own;
  std::uint64_t most = 0;
  for (const TestWork& work : run.tests) {
    const std::vector<Subject>& subjects = work.outcome.question.subjects;
    for (std::size_t i = 0; i < work.pools.size(); ++i) {
      const bool its =
          work.pools[i] == picture.pool && subjects[i].estimator->name == picture.estimator->name;
      if (its) most = std::max(most, work.outcome.secondaries(i));
    }
  }
  return most;
}

}  // namespace assay::harness
