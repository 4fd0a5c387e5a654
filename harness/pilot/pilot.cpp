#include "harness/pilot/pilot.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "stats/images/image.h"

namespace assay::harness {
namespace {

// Observations of an averaging estimator's pilot, each one primary. Other pilots have at most as
// many.
constexpr std::uint64_t many_observations = 8192;
// Primaries of an observation that shows whether an averaging estimator averages: these, or the
// suite's `primaries` if they are fewer.
constexpr std::uint64_t averaged_primaries = 8;
// The pilot of an estimator that does not average has as many primaries as the floor of evidence.
// It has 512 observations at least and many_observations at most. Such an estimator may be a chain.
constexpr std::uint64_t few_observations = 512;
constexpr std::uint64_t primaries_of_few = std::uint64_t{1} << 14;
// An image's pilot has as many images as this pays for, at least the fewest that tell their
// variance.
constexpr std::uint64_t image_elements = std::uint64_t{1} << 20;
constexpr std::uint64_t least_images = 2 * stats::least_replicates;
// Pools that a pilot of an estimator has at most.
constexpr std::uint64_t most_pools = 3;
constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// Separates the observations that show whether an estimator averages. No sampler has this name.
const std::string averages_purpose = "(averages)";

/// Number of images in a pilot; nullopt for an estimator of something else.
std::optional<std::uint64_t> usual_images(const Setup& setup, std::uint64_t primaries) {
  const auto image = setup.image();
  if (!image) return std::nullopt;
  if (setup.keeps_files()) return least_images;  // a program that renders each is dear
  return std::clamp(image_elements / (image->elements() * primaries), least_images,
                    few_observations);
}

/// Observations of this size in a pilot that a budget does not bound.
std::uint64_t usual_observations(const PreparedEstimator& estimator, std::uint64_t primaries) {
  if (const auto images = usual_images(*estimator.setup, primaries)) return *images;
  if (estimator.nature().averages) return many_observations;
  if (estimator.setup->keeps_files()) return few_observations;
  return std::clamp(primaries_of_few / primaries, few_observations, many_observations);
}

/// Primaries that a test pays for each pool. No clock may decide what a pilot draws: with a budget
/// in seconds it has the fewest observations.
std::uint64_t paid_by(const Question& question, const Subject& side) {
  const Budget budget = question.test->budget.value_or(Budget{});
  std::uint64_t most = unlimited;
  const bool averages = side.estimator->nature().averages;
  if (budget.seconds)
    most = few_observations * (averages ? 1 : side.estimator->primaries.value_or(1));
  if (!budget.primaries) return most;
  const std::uint64_t pools = most_pools * question.subjects.size();
  const double paid = pilots_part * static_cast<double>(*budget.primaries);
  return std::min(most, static_cast<std::uint64_t>(paid) / pools);
}

std::uint64_t observations_for(std::uint64_t most, const Setup& setup, std::uint64_t primaries) {
  return std::max<std::uint64_t>(most / primaries_of_observation(setup, primaries),
                                 stats::least_replicates);
}

/// A pool of all rows, or of the usual observations as far as `most` primaries reach.
std::shared_ptr<Pool> pilot_pool(const std::shared_ptr<const Setup>& setup, StreamKey key,
                                 std::uint64_t primaries, std::uint64_t usual, std::uint64_t most) {
  auto pool = std::make_shared<Pool>(setup, key, primaries);
  usual = std::min(usual, observations_for(most, *setup, primaries));
  if (setup->image()) pool->keep_observations(usual);  // files keep theirs anyway
  const std::uint64_t count = setup->observations().value_or(usual);
  if (pool->channels() <= most_kept_channels) {
    for (ChannelPlan& channel : pool->plans()) channel.keep = count;
  }
  pool->request(count);
  return pool;
}

/// A mutant has its original's declaration. Ready-made data and images have no primaries to
/// compare.
std::uint64_t averaged_primaries_of(const PreparedEstimator& estimator) {
  const Setup& setup = *estimator.setup;
  if (!estimator.nature().averages || estimator.original || setup.observations() || setup.image() ||
      setup.channel_count() > most_kept_channels) {
    return 1;
  }
  return std::min(averaged_primaries, estimator.primaries.value_or(averaged_primaries));
}

/// A pilot's sums, converted to single primaries if a recorded run has means of several.
std::shared_ptr<const Summary> sums_of(const Drawn& drawn) {
  const RecordedRun* run = as_recorded_run(*drawn.pool().setup());
  if (run == nullptr || !run->averages) return drawn.shared_summary();
  auto sums = std::make_shared<Summary>(drawn.summary());
  for (ChannelSummary& channel : sums->channels) {
    channel.moments =
        stats::moments_of_values(channel.moments, static_cast<double>(run->primaries));
  }
  return sums;
}

std::variant<Pilot, Fault> read(const std::shared_ptr<const Pool>& pool) {
  const Sample sample = pool->sample(pool->requested());
  if (const Fault* const fault = std::get_if<Fault>(&sample)) return *fault;
  const Drawn& drawn = std::get<Drawn>(sample);
  const std::uint64_t images = usual_images(*pool->setup(), pool->primaries()).value_or(0);
  return Pilot{.sums = sums_of(drawn),
               .primaries = pool->primaries(),
               .kept = pool->kept(),
               .drawn = drawn,
               .pool = pool,
               .images = drawn.images(images)};
}

std::set<std::string> compared_by_cost(const std::vector<Question>& questions) {
  std::set<std::string> names;
  for (const Question& question : questions) {
    if (methods_for(question).front().keeps != Keeps::costs) continue;
    for (const Subject& side : question.subjects) names.insert(side.estimator->name);
  }
  return names;
}

/// The most primaries of a pilot's pool that any claim on the estimator pays for.
std::uint64_t most_primaries(const PreparedEstimator& estimator,
                             const std::vector<Question>& questions) {
  std::optional<std::uint64_t> most;
  for (const Question& question : questions) {
    for (const Subject& side : question.subjects) {
      if (side.estimator->listed != estimator.listed) continue;
      most = std::max(most.value_or(0), paid_by(question, side));
    }
  }
  return most.value_or(unlimited);
}

std::string pilot_name_of(const std::string& estimator, const std::string& purpose) {
  return estimator + (purpose.empty() ? "" : "." + purpose);
}

}  // namespace

std::string pilot_name(const Subject& subject) {
  return pilot_name_of(subject.estimator->name, subject.purpose);
}

const Pilot* averaged_pilot_of(const Subject& subject, const Pilots& pilots) {
  if (!subject.purpose.empty()) return nullptr;
  return pilots.find(pilot_name_of(subject.estimator->name, averages_purpose));
}

double Pilots::primaries() const {
  double sum = 0;
  for (const auto& [name, either] : all_) {
    const auto* const pilot = std::get_if<Pilot>(&either);
    if (pilot == nullptr || !pilot->pool || pilot->pool->setup()->observations()) continue;
    sum += static_cast<double>(pilot->sums->count *
                               primaries_of_observation(*pilot->pool->setup(), pilot->primaries));
  }
  return sum;
}

void Pilots::drop_drawn() {
  std::erase_if(all_, [](const auto& entry) {
    const auto* const pilot = std::get_if<Pilot>(&entry.second);
    return pilot != nullptr && pilot->pool && !pilot->pool->setup()->observations();
  });
}

std::uint64_t primaries_of_pilots(const Question& question, const Pilots& pilots) {
  std::map<const Pilot*, std::uint64_t> paid;
  for (const Subject& side : question.subjects) {
    const Setup& setup = *side.setup;
    if (setup.observations()) continue;
    // A sweep's estimator has a pilot of its own beside those of the points.
    const std::string& name = side.estimator->name;
    const std::string& listed = side.estimator->listed;
    for (const std::string& each : {name, pilot_name_of(name, averages_purpose), pilot_name(side),
                                    listed, pilot_name_of(listed, averages_purpose)}) {
      const Pilot* const pilot = pilots.find(each);
      if (pilot == nullptr) continue;
      // Another test may have paid for more.
      const std::uint64_t most = observations_for(paid_by(question, side), setup, pilot->primaries);
      paid[pilot] =
          primaries_of_observation(setup, pilot->primaries) * std::min(pilot->sums->count, most);
    }
  }
  std::uint64_t sum = 0;
  for (const auto& [pilot, primaries] : paid) sum += primaries;
  return sum;
}

std::string where_pilots_stopped(const Question& question, const Pilots& pilots) {
  for (const Subject& subject : question.subjects) {
    const Fault* fault = pilots.fault(pilot_name(subject));
    if (fault == nullptr && subject.purpose.empty()) {
      fault = pilots.fault(pilot_name_of(subject.estimator->name, averages_purpose));
    }
    if (fault == nullptr) continue;
    return sentence_of(*fault, subject, " in the pilot");
  }
  return "";
}

const Pilot* pilot_of(const Subject& subject, const Pilots& pilots) {
  return pilots.find(pilot_name(subject));
}

ChannelData pilot_channel(const Subject& subject, const Pilot& pilot, std::size_t channel) {
  const std::size_t index = subject.channels[channel];
  return {.moments = pilot.moments(index),
          .values = pilot.values(index),
          .joint = joint_moments(pilot.sums->details(index))};
}

ChannelData pilot_channel(const Question& question, std::size_t subject, std::size_t channel,
                          const Pilots& pilots) {
  const Subject& side = question.subjects[subject];
  return pilot_channel(side, *pilot_of(side, pilots), channel);
}

std::vector<double> as_secondaries(const Subject& side, std::span<const double> values,
                                   std::uint64_t primaries) {
  const std::uint64_t each = side.averages && !is_recorded(side) ? primaries : 1;
  return mapped_indices(values.size() / each, [&](std::size_t i) {
    const std::span<const double> one = values.subspan(i * each, each);
    return std::accumulate(one.begin(), one.end(), 0.0) / static_cast<double>(each);
  });
}

std::vector<std::pair<std::string, std::shared_ptr<Pool>>> pilot_pools(
    const std::vector<const PreparedEstimator*>& estimators, const std::vector<Question>& questions,
    std::uint64_t seed) {
  std::vector<std::pair<std::string, std::shared_ptr<Pool>>> pools;
  const std::set<std::string> costly = compared_by_cost(questions);
  for (const PreparedEstimator* estimator : estimators) {
    const bool averages = estimator->nature().averages;
    const std::uint64_t primaries = averages ? 1 : estimator->primaries.value_or(1);
    pools.emplace_back(estimator->name,
                       pilot_pool(estimator->setup, key_of(*estimator, seed, 0, "pilot"), primaries,
                                  usual_observations(*estimator, primaries),
                                  most_primaries(*estimator, questions)));
    if (costly.contains(estimator->name)) {
      for (ChannelPlan& channel : pools.back().second->plans()) channel.powers = Powers::with_costs;
    }
  }
  for (const PreparedEstimator* estimator : estimators) {
    const std::uint64_t primaries = averaged_primaries_of(*estimator);
    if (primaries == 1) continue;
    const StreamKey key = key_of(*estimator, seed, 0, averages_purpose + " pilot");
    pools.emplace_back(pilot_name_of(estimator->name, averages_purpose),
                       pilot_pool(estimator->setup, key, primaries, many_observations / primaries,
                                  most_primaries(*estimator, questions)));
  }
  for (const Question& question : questions) {
    if (!question.chosen || methods_for(question).front().keeps != Keeps::points) continue;
    for (const Subject& side : question.subjects) {
      if (side.purpose.empty()) continue;
      const StreamKey key = key_of(*side.estimator, seed, 0, side.purpose + " pilot");
      pools.emplace_back(pilot_name(side), pilot_pool(side.setup, key, 1, many_observations,
                                                      most_primaries(*side.estimator, questions)));
    }
  }
  return pools;
}

Pilots run_pilots(const std::vector<const PreparedEstimator*>& estimators,
                  const std::vector<Question>& questions, std::uint64_t seed, Executor& executor,
                  Progress& progress) {
  const auto named = pilot_pools(estimators, questions, seed);
  SomePools pools;
  SomePools averaging;
  for (const auto& [name, pool] : named) {
    (name.ends_with(averages_purpose) ? averaging : pools).push_back(pool);
  }
  draw_all(pools, executor, "pilot", progress);
  // A program that hung is not waited for again. Without these pools there is no second round.
  for (const auto& pool : averaging) {
    const auto same = [&](const auto& each) { return each->setup() == pool->setup(); };
    const auto own = std::ranges::find_if(pools, same);
    if (own != pools.end() && (*own)->fault()) pool->fail(*(*own)->fault());
  }
  if (!averaging.empty()) draw_all(averaging, executor, "pilot", progress);
  Pilots pilots;
  if (interrupted()) return pilots;
  for (const auto& [name, pool] : named) pilots.add(name, read(pool));
  return pilots;
}

Pilots pilots_of(const std::vector<Question>& questions, std::uint64_t seed, Executor& executor) {
  std::map<std::string, const PreparedEstimator*> used;
  for (const Question& question : questions) {
    for (const Subject& subject : question.subjects) {
      used.emplace(subject.estimator->name, subject.estimator);
    }
  }
  return run_pilots(mapped(used, [](const auto& each) { return each.second; }), questions, seed,
                    executor, silence);
}

}  // namespace assay::harness
