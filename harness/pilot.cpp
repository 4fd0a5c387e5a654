#include "harness/pilot.h"

#include <algorithm>

#include "harness/recorded_run.h"
#include "harness/scheduler.h"
#include "stats/image.h"

namespace assay::harness {
namespace {

// Enough to know a skewness and a kurtosis of light-tailed primaries to some per cent, and cheap
// against any test. One that does not average may be a chain or an image: fewer.
constexpr std::uint64_t averaging_observations = 8192;
constexpr std::uint64_t other_observations = 512;
// Of images as many as this many elements pay for, at least the fewest that tell their variance.
constexpr std::uint64_t image_elements = std::uint64_t{1} << 20;
constexpr std::uint64_t least_images = 2 * stats::least_replicates;

std::shared_ptr<Pool> pilot_pool(const PreparedEstimator& estimator, std::uint64_t seed) {
  const bool averages = estimator.nature().averages;
  const std::uint64_t primaries = averages ? 1 : estimator.primaries.value_or(1);
  auto pool =
      std::make_shared<Pool>(estimator.setup, key_of(estimator, seed, 0, "pilot"), primaries);
  std::uint64_t usual = averages ? averaging_observations : other_observations;
  if (const auto images = usual_images(*estimator.setup, primaries)) {
    usual = *images;
    pool->keep_observations(usual);  // those of files are kept anyway
  }
  const std::uint64_t count = estimator.setup->observations().value_or(usual);
  if (pool->channels() <= most_kept_channels) {
    for (ChannelPlan& channel : pool->plans()) channel.keep = count;
  }
  pool->request(count);
  return pool;
}

std::shared_ptr<Pool> draws_pool(const Subject& subject, std::uint64_t seed) {
  auto pool = std::make_shared<Pool>(
      subject.setup, key_of(*subject.estimator, seed, 0, subject.purpose + " pilot"), 1);
  for (ChannelPlan& channel : pool->plans()) channel.keep = averaging_observations;
  pool->request(averaging_observations);
  return pool;
}

/// Moments that means of so many primaries would have these of. A kurtosis that is below 3 by chance
/// would become one that no law has (Pearson 1916: at least 1 and the square of the skewness).
stats::Moments of_primaries(stats::Moments means, std::uint64_t primaries) {
  if (!(means.m2 > 0)) return means;
  const double n = static_cast<double>(primaries);
  const double values = static_cast<double>(means.count);
  const double least = 1 + n * means.skewness() * means.skewness();
  const double kurtosis = std::max(least, 3 + n * (means.kurtosis() - 3));
  means.m3 *= n * n;
  means.m2 *= n;
  means.m4 = kurtosis * means.m2 * means.m2 / values;
  return means;
}

/// The sums of a pilot pool, as of single primaries where a recorded run has means of several.
std::shared_ptr<const Summary> sums_of(const Pool& pool) {
  const RecordedRun* run = as_recorded_run(*pool.setup());
  if (run == nullptr || !run->entry().information.averages) return pool.shared(pool.requested());
  auto sums = std::make_shared<Summary>(pool.prefix(pool.requested()));
  for (ChannelSummary& channel : sums->channels) {
    channel.moments = of_primaries(channel.moments, run->primaries());
  }
  return sums;
}

Pilot read(const Pool& pool) {
  Pilot pilot{.primaries = pool.primaries(), .trouble = pool.trouble()};
  if (!pilot.trouble.empty()) return pilot;
  pilot.sums = sums_of(pool);
  for (std::size_t i = 0; i < pool.plan().size() && pool.plan()[i].keep > 0; ++i) {
    const std::span<const double> kept = pool.values(i, pool.requested());
    if (!kept.empty()) pilot.values.emplace_back(kept.begin(), kept.end());
  }
  pilot.kept = pool.kept();
  pilot.images = pool.observations(usual_images(*pool.setup(), pool.primaries()).value_or(0));
  return pilot;
}

}  // namespace

std::optional<std::uint64_t> usual_images(const Setup& setup, std::uint64_t primaries) {
  const auto image = setup.image();
  if (!image) return std::nullopt;
  return std::clamp(image_elements / (image->elements() * primaries), least_images,
                    other_observations);
}

std::string pilot_name(const Subject& subject) {
  return subject.estimator->name + (subject.purpose.empty() ? "" : "." + subject.purpose);
}

const Pilot* pilot_of(const Subject& subject, const Pilots& pilots) {
  const auto found = pilots.find(pilot_name(subject));
  return found != pilots.end() && found->second.trouble.empty() ? &found->second : nullptr;
}

PilotChannel pilot_channel(const Subject& subject, const Pilot& pilot, std::size_t channel) {
  const std::size_t index = subject.channels[channel];
  return {.moments = pilot.moments(index),
          .values = index < pilot.values.size() ? std::span<const double>(pilot.values[index])
                                                : std::span<const double>()};
}

PilotChannel pilot_channel(const Question& question, std::size_t subject, std::size_t channel,
                           const Pilots& pilots) {
  const Subject& side = question.subjects[subject];
  return pilot_channel(side, pilots.at(pilot_name(side)), channel);
}

Pilots run_pilots(const std::vector<const PreparedEstimator*>& estimators, const PilotRun& run,
                  Progress& progress) {
  std::vector<std::string> names;
  std::vector<std::shared_ptr<Pool>> pools;
  for (const PreparedEstimator* estimator : estimators) {
    names.push_back(estimator->name);
    pools.push_back(pilot_pool(*estimator, run.seed));
    if (!run.with_cost.contains(estimator->name)) continue;
    for (ChannelPlan& channel : pools.back()->plans()) channel.with_cost = true;
  }
  for (const Subject* subject : run.draws) {
    names.push_back(pilot_name(*subject));
    pools.push_back(draws_pool(*subject, run.seed));
  }
  draw_all(pools, {.threads = run.threads, .phase = "pilot"}, progress);
  Pilots pilots;
  for (std::size_t i = 0; i < pools.size(); ++i) pilots.emplace(names[i], read(*pools[i]));
  return pilots;
}

}  // namespace assay::harness
