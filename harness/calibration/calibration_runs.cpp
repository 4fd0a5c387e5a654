#include "harness/calibration/calibration_runs.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "harness/base/interrupt.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/plan.h"
#include "harness/run/looks.h"
#include "harness/run/pools.h"
#include "harness/theta/ask.h"

namespace assay::harness {
namespace {

using reports::Verdict;

constexpr double usual_beta = 0.01;

/// One test of one case at one alpha, as a suite of its own.
struct Item {
  std::size_t alpha;
  std::size_t of;
  Trial trial;
  bool proof;
  Suite suite;
};

using Counts = std::vector<std::vector<CaseCounts>>;

VerdictCounts& counts_of(Counts& counts, const Item& item) {
  return counts[item.alpha][item.of][static_cast<std::size_t>(item.trial)];
}

std::vector<Item> items_of(const CalibrationBench& bench, const std::vector<double>& alphas) {
  std::vector<Item> items;
  for (std::size_t a = 0; a < alphas.size(); ++a) {
    for (std::size_t c = 0; c < bench.cases.size(); ++c) {
      const CalibrationCase& each = bench.cases[c];
      const std::optional<TestEntry>* const tests[] = {&each.holds, &each.off, &each.alone};
      for (std::size_t t = 0; t < trials_of_a_case; ++t) {
        if (!*tests[t]) continue;
        Suite suite{.name = "calibration", .stem = "calibration", .alpha = alphas[a]};
        // A proof errs by passing, so its level is beta.
        suite.beta = each.proof ? alphas[a] : usual_beta;
        suite.tests = {**tests[t]};
        items.push_back({a, c, static_cast<Trial>(t), each.proof, std::move(suite)});
      }
    }
  }
  return items;
}

Pilots pilots_of(const std::vector<Question>& questions, std::uint64_t seed) {
  std::map<std::string, const PreparedEstimator*> used;
  for (const Question& question : questions) {
    for (const Subject& subject : question.subjects) {
      used.emplace(subject.estimator->name, subject.estimator);
    }
  }
  std::vector<const PreparedEstimator*> estimators;
  for (const auto& [name, estimator] : used) estimators.push_back(estimator);
  Silence silence;
  return run_pilots(estimators, pilot_run_of(questions, seed, threads(1)), silence);
}

/// Turns off histograms, which a calibration does not show.
void leave_out_pictures(const Pools& pools) {
  for (const auto& pool : pools.all()) {
    for (ChannelPlan& channel : pool->plans()) channel.histogram_high = channel.histogram_low;
  }
}

void tally(VerdictCounts& counts, const TestOutcome& outcome, bool proof) {
  const auto any_red = [](const std::vector<Gate>& gates) {
    return std::ranges::any_of(gates, &Gate::is_red);
  };
  const bool red = any_red(outcome.plan.gates) || any_red(outcome.gates);
  const bool passed = outcome.verdict == Verdict::pass;
  const bool failed = outcome.verdict == Verdict::fail;
  counts.passed += passed ? 1 : 0;
  counts.failed += failed ? 1 : 0;
  counts.inconclusive += outcome.verdict == Verdict::inconclusive ? 1 : 0;
  counts.invalid +=
      outcome.verdict == Verdict::invalid || outcome.verdict == Verdict::error ? 1 : 0;
  counts.red += red ? 1 : 0;
  counts.mistaken_not_red += (proof ? passed : failed) && !red ? 1 : 0;
  counts.observations += outcome.secondaries();
  ++counts.methods[outcome.plan.method.name];
}

void run_once(const CalibrationBench& bench, const std::vector<Item>& items, std::uint64_t seed,
              Counts& counts) {
  std::vector<Question> questions;
  for (const Item& item : items) {
    questions.push_back(ask(item.suite.tests[0], bench.estimators, seed));
  }
  const Pilots pilots = pilots_of(questions, seed);
  Pools pools;
  std::vector<std::unique_ptr<TestWork>> works(items.size());
  std::vector<TestWork*> open;
  for (std::size_t i = 0; i < items.size(); ++i) {
    VerdictCounts& mine = counts_of(counts, items[i]);
    ++mine.runs;
    const std::vector<FamilyPlace> place = places(items[i].suite, {questions[i]});
    try {
      Plan plan = plan_test(questions[i], place[0], pilots,
                            choose_primaries({questions[i]}, place, pilots));
      works[i] = std::make_unique<TestWork>(TestWork{
          .outcome = {.question = questions[i], .place = place[0], .plan = std::move(plan)},
          .verdict_only = true});
    } catch (const InputError&) {
      // A run would stop before sampling.
      ++mine.invalid;
      continue;
    }
    TestOutcome& outcome = works[i]->outcome;
    works[i]->pools = pools.for_question(outcome.question, outcome.plan, seed, pilots);
    open.push_back(works[i].get());
  }
  leave_out_pictures(pools);
  Silence silence;
  sample_in_looks(open, pools.all(), {.executor = threads(1)}, silence);
  if (interrupted()) return;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (works[i]) tally(counts_of(counts, items[i]), works[i]->outcome, items[i].proof);
  }
}

void add(Counts& sum, const Counts& more) {
  for (std::size_t a = 0; a < sum.size(); ++a) {
    for (std::size_t c = 0; c < sum[a].size(); ++c) {
      for (std::size_t t = 0; t < trials_of_a_case; ++t) sum[a][c][t].add(more[a][c][t]);
    }
  }
}

}  // namespace

void VerdictCounts::add(const VerdictCounts& other) {
  runs += other.runs;
  passed += other.passed;
  failed += other.failed;
  inconclusive += other.inconclusive;
  invalid += other.invalid;
  red += other.red;
  mistaken_not_red += other.mistaken_not_red;
  observations += other.observations;
  for (const auto& [method, count] : other.methods) methods[method] += count;
}

Counts run_calibration(const CalibrationBench& bench, const CalibrationRuns& options,
                       const std::function<void(std::uint64_t)>& done) {
  const std::vector<Item> items = items_of(bench, options.alphas);
  const Counts none(options.alphas.size(), std::vector<CaseCounts>(bench.cases.size()));
  Counts sum = none;
  std::atomic<std::uint64_t> next{0};
  std::mutex mutex;
  std::exception_ptr trouble;
  const auto work = [&](bool tells) {
    Counts mine = none;
    try {
      for (std::uint64_t run = next++; run < options.runs && !interrupted(); run = next++) {
        run_once(bench, items, options.seed + run, mine);
        if (tells) done(std::min(next.load(), options.runs));
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      trouble = std::current_exception();
      next = options.runs;
    }
    const std::lock_guard lock(mutex);
    add(sum, mine);
  };
  const unsigned threads =
      options.threads != 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::jthread> helpers;
  for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work, false);
  work(true);
  helpers.clear();
  if (trouble) std::rethrow_exception(trouble);
  return sum;
}

}  // namespace assay::harness
