#include "harness/run/unit_cost.h"

#include <algorithm>

#include "harness/base/interrupt.h"
#include "harness/sampling/executor.h"

namespace assay::harness {
namespace {

constexpr std::uint64_t timed_primaries = 16384;

std::shared_ptr<Pool> timed_pool(const Pool& pool, const PreparedEstimator& estimator,
                                 const std::string& purpose, std::uint64_t seed) {
  const StreamKey key = key_of(estimator, seed, 0, purpose.empty() ? "cost" : purpose + "#cost");
  auto timed = std::make_shared<Pool>(pool.setup(), key, pool.primaries());
  for (std::size_t i = 0; i < pool.plan().size(); ++i) {
    timed->plans()[i].cells = pool.plan()[i].cells;
  }
  const std::uint64_t one = primaries_of_observation(*pool.setup(), pool.primaries());
  timed->request(std::max<std::uint64_t>(1, timed_primaries / one));
  return timed;
}

UnitCost unit_cost(const Summary& summary) {
  const double n = static_cast<double>(summary.count);
  return {.rays = static_cast<double>(summary.cost.rays()) / n,
          .samples = static_cast<double>(summary.cost.samples) / n,
          .seconds = summary.seconds / n};
}

/// The pilot's observations, if they have as many primaries as the pool's. An image or another
/// non-averaging observation may take minutes.
const Summary* piloted(const Pool& pool, const PreparedEstimator& estimator,
                       const std::string& purpose, const Pilots& pilots) {
  const Pilot* const pilot = pilots.find(estimator.name);
  if (!purpose.empty() || estimator.nature().averages || pilot == nullptr) return nullptr;
  return pilot->primaries == pool.primaries() ? pilot->sums.get() : nullptr;
}

}  // namespace

UnitCosts measure_costs(const PlannedRun& planned, const std::shared_ptr<Executor>& executor,
                        Progress& progress) {
  UnitCosts costs;
  std::vector<const Pool*> timed;
  SomePools pools;
  for (const auto& run : planned.suites) {
    const auto add = [&](const Pool& pool, const PreparedEstimator& estimator,
                         const std::string& purpose) {
      if (const Summary* known = piloted(pool, estimator, purpose, run->pilots)) {
        costs.emplace(&pool, unit_cost(*known));
      } else if (pool.fault()) {
        costs.emplace(&pool, *pool.fault());
      } else if (!pool.setup()->observations() && !std::ranges::count(timed, &pool)) {
        timed.push_back(&pool);
        pools.push_back(timed_pool(pool, estimator, purpose, run->seed));
      }
    };
    for (const TestWork& work : run->tests) {
      for (std::size_t i = 0; i < work.pools.size(); ++i) {
        const Subject& side = work.outcome.question.subjects[i];
        add(*work.pools[i], *side.estimator, side.purpose);
      }
    }
  }
  draw_all(pools, {.executor = executor, .phase = "costs"}, progress);
  stop_if_interrupted();
  for (std::size_t i = 0; i < pools.size(); ++i) {
    const Sample sample = pools[i]->sample(pools[i]->requested());
    if (sample.drawn() != nullptr) {
      costs.emplace(timed[i], unit_cost(sample.drawn()->summary()));
    } else {
      costs.emplace(timed[i], *sample.fault());
    }
  }
  return costs;
}

}  // namespace assay::harness
