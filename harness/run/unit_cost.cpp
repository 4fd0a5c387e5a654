#include "harness/run/unit_cost.h"

#include <algorithm>

#include "harness/base/interrupt.h"
#include "harness/sampling/executor.h"

namespace assay::harness {
namespace {

constexpr std::uint64_t timed_primaries = 16384;

struct Timed {
  const Pool* of;
  std::shared_ptr<Pool> pool;
};

class Timings {
 public:
  void add(const Pool& pool, const PreparedEstimator& estimator, const std::string& purpose,
           std::uint64_t seed) {
    const auto same = [&](const Timed& timed) { return timed.of == &pool; };
    if (pool.setup()->observations() || std::any_of(all_.begin(), all_.end(), same)) return;
    const StreamKey key = key_of(estimator, seed, 0, purpose.empty() ? "cost" : purpose + "#cost");
    all_.push_back({&pool, std::make_shared<Pool>(pool.setup(), key, pool.primaries())});
    for (std::size_t i = 0; i < pool.plan().size(); ++i) {
      all_.back().pool->plans()[i].cells = pool.plan()[i].cells;
    }
    const auto image = pool.setup()->image();
    const std::uint64_t one = pool.primaries() * (image ? image->elements() : 1);
    all_.back().pool->request(std::max<std::uint64_t>(1, timed_primaries / one));
  }
  const std::vector<Timed>& all() const { return all_; }

 private:
  std::vector<Timed> all_;
};

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
  Timings timings;
  UnitCosts costs;
  for (const auto& run : planned.suites) {
    const auto add = [&](const Pool& pool, const PreparedEstimator& estimator,
                         const std::string& purpose) {
      if (const Summary* known = piloted(pool, estimator, purpose, run->pilots)) {
        costs.emplace(&pool, unit_cost(*known));
      } else if (pool.fault()) {
        costs.emplace(&pool, *pool.fault());
      } else {
        timings.add(pool, estimator, purpose, run->seed);
      }
    };
    for (const TestWork& work : run->tests) {
      for (std::size_t i = 0; i < work.pools.size(); ++i) {
        const Subject& side = work.outcome.question.subjects[i];
        add(*work.pools[i], *side.estimator, side.purpose);
      }
    }
    for (const Picture& picture : run->pictures) add(*picture.pool, *picture.estimator, "");
  }
  std::vector<std::shared_ptr<Pool>> pools;
  for (const Timed& timed : timings.all()) pools.push_back(timed.pool);
  draw_all(pools, {.executor = executor, .phase = "costs"}, progress);
  stop_if_interrupted();
  for (const Timed& timed : timings.all()) {
    const Sample sample = timed.pool->sample(timed.pool->requested());
    if (sample.drawn() != nullptr) {
      costs.emplace(timed.of, unit_cost(sample.drawn()->summary()));
    } else {
      costs.emplace(timed.of, *sample.fault());
    }
  }
  return costs;
}

}  // namespace assay::harness
