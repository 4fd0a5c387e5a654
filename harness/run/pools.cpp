#include "harness/run/pools.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "harness/draws/sampler_setup.h"
#include "harness/plan/independence.h"
#include "harness/question/question.h"
#include "stats/means/student_t.h"

namespace assay::harness {
namespace {

// The histogram spans so many standard deviations to each side, within the channel's range.
constexpr double histogram_deviations = 5;

using stats::Range;

/// Bounds of a histogram that holds both ends.
ChannelPlan with_histogram(Range range) {
  ChannelPlan plan{.keep = plotted_values};
  if (!(range.low < range.high)) return plan;
  plan.histogram_low = range.low;
  plan.histogram_high = std::nextafter(range.high, std::numeric_limits<double>::infinity());
  return plan;
}

std::vector<ChannelPlan> sampler_plan(const SamplerSetup& setup) {
  std::vector<ChannelPlan> plan = mapped(setup.marginals(), [](const Marginal& marginal) {
    return with_histogram({marginal.low, marginal.high});
  });
  plan.resize(setup.channel_count());
  return plan;
}

std::vector<ChannelPlan> estimator_plan(const Pool& pool, const PreparedEstimator& estimator,
                                        const Pilots& pilots) {
  std::vector<ChannelPlan> plan;
  // Images are shown as maps, without a histogram of each pixel.
  if (pool.is_ready_made() || pool.setup()->image()) return {};
  const Pilot* const pilot = pilots.find(estimator.name);  // null if it is read row by row
  const double averaged = estimator.nature().averages ? static_cast<double>(pool.primaries()) : 1;
  for (std::size_t i = 0; i < pool.channels(); ++i) {
    if (pilot == nullptr || pilot->moments(i).count < 2) {
      plan.push_back({.keep = plotted_values});
      continue;
    }
    const stats::Moments& moments = pilot->moments(i);
    Range range{moments.minimum, moments.maximum};
    if (!pool.setup()->observations()) {  // the pilot of a file is all of it
      const Channel channel = pool.setup()->channel(i);
      const double reach = histogram_deviations * std::sqrt(moments.variance() / averaged);
      range = {std::max({channel.low, range.low, moments.mean - reach}),
               std::min({channel.high, range.high, moments.mean + reach})};
    }
    plan.push_back(with_histogram(range));
  }
  return plan;
}

/// Counts draws in cells. It uses the pool's own set-up, whose cells its workers count; the
/// subject's may belong to an equal sampler. If the density is out of reach, the plan or the look
/// says so.
void count_cells(const Subject& side, Pool& pool) {
  const auto& draws = dynamic_cast<const SamplerSetup&>(*pool.setup());
  try {
    pool.plans()[side.channels[0]].cells = draws.cell_numbers();
  } catch (const NoDensity&) {
  } catch (const std::domain_error&) {
  }
}

void keep_values(std::uint64_t count, const Subject& side, Pool& pool) {
  for (const std::size_t channel : side.channels.all()) {
    std::uint64_t& keep = pool.plans()[channel].keep;
    keep = std::max(keep, count);
  }
}

void keep_for(const Plan& plan, const Subject& side, Pool& pool) {
  const Method& method = plan.method;
  const std::uint64_t most = plan.most_secondaries();
  if (method.keeps == Keeps::values || method.keeps == Keeps::points) keep_values(most, side, pool);
  if (method.keeps == Keeps::images) pool.keep_observations(most);
  if (shows_order(side)) keep_values(std::min(ordered_values, most), side, pool);
  // An image may cost as much as the rest of a look: was_activated takes a mutant's first one.
  if (side.estimator->original && pool.elements() > 0) pool.keep_observations(1);
  for (const std::size_t channel : side.channels.all()) {
    if (powers_of(method.keeps) == Powers::none) break;
    Powers& powers = pool.plans()[channel].powers;
    powers = std::max(powers, powers_of(method.keeps));
  }
  if (method.keeps == Keeps::group_variances) {
    std::vector<std::size_t> channels;
    std::ranges::copy(side.channels.all(), std::back_inserter(channels));
    pool.keep_group_variances(std::move(channels));
  }
  if (method.keeps == Keeps::blocks) pool.keep_blocks();
  if (method.keeps == Keeps::cells) count_cells(side, pool);
}

}  // namespace

PoolIdentity pool_identity(const Subject& side, std::uint64_t primaries, std::uint64_t seed) {
  const PreparedEstimator& estimator = *side.estimator;
  return {estimator.entry->information.name,
          estimator.parameters,
          estimator.folder,
          side.purpose,
          stream_of(side, seed).bits,
          primaries};
}

std::shared_ptr<Pool> Pools::find_or_make(const Subject& side, std::uint64_t primaries,
                                          std::uint64_t seed, const Pilots& pilots) {
  std::shared_ptr<Pool>& pool = pools_[pool_identity(side, primaries, seed)];
  if (pool) return pool;
  const std::string& name = side.estimator->name;
  pool = std::make_shared<Pool>(side.setup, stream_of(side, seed), primaries);
  const Pilot* const pilot = pilots.find(name);
  const auto rows = side.setup->observations();
  if (rows && pilot != nullptr && pilot->kept && pilot->kept->size() == *rows) {
    pool->take_known(pilot->kept);
  }
  // Asking again may take another time-out.
  if (const Fault* fault = pilots.fault(pilot_name(side))) pool->fail(*fault);
  const auto* draws = dynamic_cast<const SamplerSetup*>(side.setup.get());
  pool->plan(draws != nullptr ? sampler_plan(*draws)
                              : estimator_plan(*pool, *side.estimator, pilots));
  all_.push_back(pool);
  return pool;
}

std::vector<std::shared_ptr<Pool>> Pools::for_question(const Question& question, const Plan& plan,
                                                       std::uint64_t seed, const Pilots& pilots) {
  return mapped_indices(question.subjects.size(), [&](std::size_t subject) {
    const Subject& side = question.subjects[subject];
    std::shared_ptr<Pool> pool = find_or_make(side, plan.primaries[subject], seed, pilots);
    keep_for(plan, side, *pool);
    for (const std::uint64_t size : plan.looks.sizes) pool->mark(side.secondaries(size));
    for (const std::uint64_t size : plan.postponed) pool->mark(side.secondaries(size));
    return pool;
  });
}

}  // namespace assay::harness
