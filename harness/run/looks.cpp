#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "harness/draws/sampler_setup.h"
#include "harness/plan/plan.h"
#include "harness/run/planned_run.h"
#include "stats/means/student_t.h"

namespace assay::harness {
namespace {

/// Counts decided tests. Draws only move the clock on.
class Claims final : public Progress {
 public:
  Claims(Progress& progress, std::uint64_t tests) : progress_(progress) {
    progress_.begin({.total = tests, .unit = tests == 1 ? "claim" : "claims"});
  }
  ~Claims() override { progress_.end(); }
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  void count() { progress_.advance(++decided_); }
  void begin(const Phase&) override {}
  void advance(std::uint64_t) override { progress_.advance(decided_); }
  void end() override {}

 private:
  Progress& progress_;
  std::uint64_t decided_ = 0;
};

/// CPU seconds of suites with a budget in seconds; each pool counts once.
using Clocks = std::map<const Budget*, double>;

Clocks read_clocks(const std::vector<TestWork*>& tests) {
  std::set<std::pair<const Budget*, const Pool*>> counted;
  Clocks clocks;
  for (const TestWork* work : tests) {
    const Budget* const budget = work->suite_budget;
    if (budget == nullptr || !budget->seconds) continue;
    for (const auto& pool : work->pools) {
      if (counted.emplace(budget, pool.get()).second) clocks[budget] += pool->seconds();
    }
  }
  return clocks;
}

/// The size of the next look; of the last, what it may be put off to.
std::uint64_t next_size(const TestOutcome& outcome) {
  const Plan& plan = outcome.plan;
  if (outcome.look + 1 < plan.looks.count()) return plan.looks.sizes[outcome.look + 1];
  return plan.postponed.empty() ? outcome.secondaries() : plan.postponed.front();
}

void go_on(TestOutcome& outcome) {
  Plan& plan = outcome.plan;
  if (outcome.look + 1 < plan.looks.count()) {
    ++outcome.look;
    return;
  }
  plan.looks = one_look(plan.postponed.front(), outcome.place.share);
  plan.postponed.erase(plan.postponed.begin());
  outcome.look = 0;
  outcome.history.clear();
}

/// True if a budget in seconds is spent, or the next look would spend it.
bool is_spent(const TestWork& work, const Clocks& clocks) {
  const double growth = static_cast<double>(next_size(work.outcome)) /
                        static_cast<double>(work.outcome.secondaries());
  const auto clock = clocks.find(work.suite_budget);
  if (clock != clocks.end() && growth * clock->second > *work.suite_budget->seconds) return true;
  const std::optional<Budget>& budget = work.outcome.question.test->budget;
  if (!budget || !budget->seconds) return false;
  const std::optional<DrawnTest> test = drawn(work);
  if (!test) return false;
  double seconds = 0;
  for (const Drawn& sample : test->samples) seconds += sample.summary().seconds;
  return growth * seconds > *budget->seconds;
}

bool is_drawn(const TestWork& work) {
  for (std::size_t i = 0; i < work.pools.size(); ++i) {
    if (!work.pools[i]->holds(work.outcome.secondaries(i))) return false;
  }
  return true;
}

bool take_next(TestWork& work, const Clocks& clocks) {
  TestOutcome& outcome = work.outcome;
  const bool spent = is_spent(work, clocks);
  take_look(work, !spent);
  const bool ended_early = outcome.look + 1 < outcome.plan.looks.count() &&
                           outcome.verdict == reports::Verdict::inconclusive;
  if (spent && ended_early) outcome.message += "; its budget in seconds ended here";
  if (!outcome.decided) go_on(outcome);
  return !outcome.decided;
}

/// Primaries that a test's next look adds.
std::uint64_t cost_of_look(const TestWork& work) {
  std::uint64_t cost = 0;
  for (std::size_t i = 0; i < work.pools.size(); ++i) {
    const std::uint64_t wanted = work.outcome.secondaries(i), there = work.pools[i]->requested();
    if (wanted > there) cost += (wanted - there) * work.pools[i]->primaries();
  }
  return cost;
}

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
    pool.keep_group_variances(mapped(side.channels.all(), std::identity()));
  }
  if (method.keeps == Keeps::blocks) pool.keep_blocks();
  if (method.keeps == Keeps::cells) count_cells(side, pool);
}

}  // namespace

void sample_in_looks(const std::vector<TestWork*>& tests,
                     const std::vector<std::shared_ptr<Pool>>& pools, const Rounds& rounds,
                     Progress& progress) {
  Claims claims(progress, tests.size());
  std::vector<TestWork*> open = tests;
  bool go_on = true;
  while (go_on && !open.empty() && !interrupted()) {
    std::vector<TestWork*> next = open;
    if (rounds.cheapest_first) {
      next = {*std::ranges::min_element(open, {},
                                        [](const TestWork* work) { return cost_of_look(*work); })};
    }
    for (TestWork* work : next) {
      for (std::size_t i = 0; i < work->pools.size(); ++i) {
        work->pools[i]->request(work->outcome.secondaries(i));
      }
    }
    draw_all(pools, *rounds.executor, "sampling", claims);
    // A fault may then be that of a program whose wait was cut off: it is no verdict.
    if (interrupted()) std::erase_if(next, [](const TestWork* work) { return !is_drawn(*work); });
    const Clocks clocks = read_clocks(tests);
    for (TestWork* work : next) {
      if (take_next(*work, clocks)) continue;
      std::erase(open, work);
      claims.count();
      if (rounds.decided && !rounds.decided(*work)) go_on = false;
    }
  }
}

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
  pool->plans() =
      draws != nullptr ? sampler_plan(*draws) : estimator_plan(*pool, *side.estimator, pilots);
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
