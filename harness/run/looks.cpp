#include "harness/run/looks.h"

#include <algorithm>
#include <map>
#include <set>

#include "harness/base/interrupt.h"
#include "harness/plan/sizes.h"

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

}  // namespace assay::harness
