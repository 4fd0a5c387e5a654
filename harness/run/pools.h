#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "harness/plan/outcome.h"
#include "harness/pilot/pilot.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// Stored values of every channel, for the normal quantile plot.
inline constexpr std::uint64_t plotted_values = 2000;

/// All pools of a run. Tests that draw the same stream from the same plugin share one.
class Pools {
 public:
  /// The pools of a test, one for each subject, planned for what the method keeps.
  std::vector<std::shared_ptr<Pool>> for_question(const Question& question, const Plan& plan,
                                                  std::uint64_t seed, const Pilots& pilots);
  /// An estimator's pool for the suite's picture.
  struct Shown {
    const PreparedEstimator& estimator;
    std::uint32_t copy;
    std::uint64_t primaries;
  };
  std::shared_ptr<Pool> for_picture(const Shown& picture, std::uint64_t seed, const Pilots& pilots);

  const std::vector<std::shared_ptr<Pool>>& all() const { return all_; }

 private:
  std::shared_ptr<Pool> for_subject(const Question& question, std::size_t subject, const Plan& plan,
                                    std::uint64_t seed, const Pilots& pilots);
  struct Wanted {
    const PreparedEstimator& estimator;
    std::shared_ptr<const Setup> setup;
    std::string purpose;
    std::uint32_t copy;
    std::uint64_t primaries;
  };
  std::shared_ptr<Pool> find_or_make(const Wanted& wanted, std::uint64_t seed,
                                     const Pilots& pilots);

  using Identity =
      std::tuple<std::string, std::string, std::string, std::string, std::uint64_t, std::uint64_t>;
  std::map<Identity, std::shared_ptr<Pool>> pools_;
  std::vector<std::shared_ptr<Pool>> all_;
};

}  // namespace assay::harness
