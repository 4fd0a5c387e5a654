#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "harness/plan/forecast.h"
#include "harness/run/planned_run.h"

namespace assay::harness {
namespace {

// A shard may draw so many times its fair part, to save what another shard would draw again.
constexpr double slack = 1.1;

/// The cost of a prefix of each pool.
using Prefixes = std::map<PoolIdentity, double>;

Prefixes prefixes_of(const TestOutcome& test, const SuiteRun& run) {
  Prefixes cost;
  if (!test.plan.invalid.empty()) return cost;
  const std::uint64_t expected = expected_secondaries(test, run.pilots);
  for (std::size_t i = 0; i < test.question.subjects.size(); ++i) {
    const Subject& side = test.question.subjects[i];
    const std::uint64_t primaries = test.plan.primaries[i];
    const auto each = observation_cost(side, primaries, run.pilots);
    const double price =
        each ? std::max(1.0, each->rays + each->samples) : static_cast<double>(primaries);
    double& prefix = cost[pool_identity(side, primaries, run.seed)];
    prefix = std::max(prefix, static_cast<double>(side.secondaries(expected)) * price);
  }
  return cost;
}

double total_of(const Prefixes& cost) {
  return std::accumulate(cost.begin(), cost.end(), 0.0,
                         [](double sum, const auto& each) { return sum + each.second; });
}

/// The cost of both, with prefixes of one stream drawn once.
Prefixes joined_prefixes(Prefixes cost, const Prefixes& more) {
  for (const auto& [stream, prefix] : more) cost[stream] = std::max(cost[stream], prefix);
  return cost;
}

/// The shard of each test, from 0.
std::vector<std::size_t> dealt(const std::vector<Prefixes>& costs, unsigned count) {
  std::vector<std::size_t> dearest(costs.size());
  std::iota(dearest.begin(), dearest.end(), std::size_t{0});
  std::ranges::stable_sort(dearest, std::ranges::greater{},
                           [&](std::size_t test) { return total_of(costs[test]); });
  Prefixes all;
  double bound = 0;
  for (const Prefixes& cost : costs) {
    all = joined_prefixes(std::move(all), cost);
    bound = std::max(bound, total_of(cost));
  }
  bound = slack * std::max(bound, total_of(all) / count);
  std::vector<Prefixes> loads(count);
  std::vector<std::size_t> shards(costs.size());
  for (const std::size_t test : dearest) {
    const auto best = std::ranges::min_element(loads, {}, [&](const Prefixes& load) {
      const double with = total_of(joined_prefixes(load, costs[test]));
      return std::tuple(std::max(with, bound), with - total_of(load), with);
    });
    *best = joined_prefixes(std::move(*best), costs[test]);
    shards[test] = static_cast<std::size_t>(best - loads.begin());
  }
  return shards;
}

}  // namespace

void keep_shard(const SuiteRuns& runs, std::pair<unsigned, unsigned> shard) {
  std::vector<Prefixes> costs;
  for (const auto& run : runs) {
    for (const TestWork& work : run->tests) costs.push_back(prefixes_of(work.outcome, *run));
    // One that cannot be tested costs nothing.
    costs.resize(costs.size() + run->untested.size());
  }
  const std::vector<std::size_t> shards = dealt(costs, shard.second);
  auto next = shards.begin();
  for (const auto& run : runs) {
    const auto is_elsewhere = [&](const TestEntry* test) {
      const std::size_t owner = *next++ + 1;
      if (owner == shard.first) return false;
      run->elsewhere.push_back({.shard = owner,
                                .position = position_of(*test, run->suite),
                                .id = test->id,
                                .name = test->name,
                                .claim = test->claim.text,
                                .line = test->where.line});
      return true;
    };
    std::erase_if(run->tests,
                  [&](const TestWork& work) { return is_elsewhere(work.outcome.question.test); });
    std::erase_if(run->untested, [&](const Untested& each) { return is_elsewhere(each.test); });
  }
}

}  // namespace assay::harness
