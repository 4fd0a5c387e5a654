#include "harness/pilot.h"

#include "harness/scheduler.h"

namespace assay::harness {
namespace {

// Enough to know a skewness and a kurtosis of light-tailed primaries to some per cent, and cheap
// against any test. One that does not average may be a chain or an image: fewer.
constexpr std::uint64_t averaging_observations = 8192;
constexpr std::uint64_t other_observations = 512;

std::shared_ptr<Pool> pilot_pool(const PreparedEstimator& estimator, std::uint64_t seed) {
  const bool averages = estimator.entry->information.averages;
  const std::uint64_t primaries = averages ? 1 : estimator.primaries.value_or(1);
  auto pool =
      std::make_shared<Pool>(estimator.setup, key_of(estimator, seed, 0, "pilot"), primaries);
  pool->request(averages ? averaging_observations : other_observations);
  return pool;
}

Pilot read(const Pool& pool) {
  Pilot pilot{.channels = {}, .primaries = pool.primaries(), .trouble = pool.trouble()};
  if (!pilot.trouble.empty()) return pilot;
  for (const ChannelSummary& channel : pool.prefix(pool.requested()).channels) {
    pilot.channels.push_back(channel.moments);
  }
  return pilot;
}

}  // namespace

Pilots run_pilots(const std::vector<const PreparedEstimator*>& estimators, const PilotRun& run,
                  Progress& progress) {
  std::vector<std::string> names;
  std::vector<std::shared_ptr<Pool>> pools;
  for (const PreparedEstimator* estimator : estimators) {
    if (estimator->setup->observations()) continue;
    names.push_back(estimator->name);
    pools.push_back(pilot_pool(*estimator, run.seed));
  }
  draw_all(pools, {.threads = run.threads, .phase = "pilot"}, progress);
  Pilots pilots;
  for (std::size_t i = 0; i < pools.size(); ++i) pilots.emplace(names[i], read(*pools[i]));
  return pilots;
}

}  // namespace assay::harness
