#pragma once

// A test's pools, and the looks at what they draw.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "harness/base/work.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/run/evaluate.h"
#include "harness/sampling/executor.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// Stored values of every channel, for the normal quantile plot.
inline constexpr std::uint64_t plotted_values = 2000;

/// Plugin, parameters, folder, purpose, stream and primaries: equal ones draw the same.
using PoolIdentity =
    std::tuple<std::string, std::string, std::string, std::string, std::uint64_t, std::uint64_t>;
PoolIdentity pool_identity(const Subject& side, std::uint64_t primaries, std::uint64_t seed);

/// All pools of a run. Tests that draw the same stream from the same plugin share one.
class Pools {
 public:
  /// The pools of a test, one for each subject, planned for what the method keeps.
  std::vector<std::shared_ptr<Pool>> for_question(const Question& question, const Plan& plan,
                                                  std::uint64_t seed, const Pilots& pilots);

  const std::vector<std::shared_ptr<Pool>>& all() const { return all_; }

 private:
  /// The pool of a subject, without plans for a test.
  std::shared_ptr<Pool> find_or_make(const Subject& side, std::uint64_t primaries,
                                     std::uint64_t seed, const Pilots& pilots);

  std::map<PoolIdentity, std::shared_ptr<Pool>> pools_;
  std::vector<std::shared_ptr<Pool>> all_;
};

struct Rounds {
  std::shared_ptr<Executor> executor = threads();
  bool cheapest_first = false;  ///< A round takes one look, that with the fewest primaries.
  /// Hears of each test when it is decided. If it answers no, nothing more is drawn.
  std::function<bool(const TestWork&)> decided = {};
};

/// Draws in rounds: in each, every undecided test takes its next look. It ends when every test is
/// decided or has taken its last look. A test's data depend on its own plan alone. Stops early when
/// the user interrupts or `decided` says no; tests are then left undecided.
void sample_in_looks(const std::vector<TestWork*>& tests,
                     const std::vector<std::shared_ptr<Pool>>& pools, const Rounds& rounds,
                     Progress& progress);

}  // namespace assay::harness
