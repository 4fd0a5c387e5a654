#include "harness/run/planned_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "estimators/core/waiting.h"
#include "harness/base/refuse.h"
#include "harness/plan/plan.h"
#include "harness/theta/ask.h"

namespace assay::harness {
namespace {

/// Splits the suite's primaries over all its tests by weight, selected or not: what a test may draw
/// is a function of the suite alone. Claims in seconds are timed on whole replicates.
void share_budget(Suite& suite) {
  if (!suite.budget || !suite.budget->primaries) return;
  double weights = 0;
  for (const TestEntry& test : suite.tests) weights += test.weight;
  for (TestEntry& test : suite.tests) {
    if (test.cost == CostKind::seconds) continue;
    const auto share = static_cast<std::uint64_t>(static_cast<double>(*suite.budget->primaries) *
                                                  test.weight / weights);
    if (!test.budget) test.budget.emplace();
    if (test.budget->primaries.value_or(share) < share) continue;
    test.budget->primaries = share;
    test.budget->of_suite = true;
  }
}

// Half of the way to laws that share no value still makes a quick test.
constexpr double coarsest_probability = 0.5;

void coarsen(Suite& suite, const RunOptions& options) {
  for (TestEntry& test : suite.tests) {
    if (!test.detect) continue;
    double& detect = test.detect->value;
    const double most = test.claim.left.row->is_a_probability()
                            ? std::max(detect, coarsest_probability)
                            : std::numeric_limits<double>::infinity();
    detect = std::min(detect * options.coarsen, most);
    if (test.allow && test.detect->value <= test.allow->value) {
      refuse(test.place_of("detect"),
             "`--coarsen {:g}` brings `detect` down to `allow`; `detect` must stay above it",
             options.coarsen);
    }
  }
}

using Used = std::vector<const PreparedEstimator*>;

/// Estimators of the chosen tests, in the suite's order. A reference has nothing to draw.
Used used_by(const SuiteRun& run) {
  std::set<std::string> wanted;
  for (const Question& question : run.questions) {
    for (const Subject& subject : question.subjects) {
      if (question.chosen) wanted.insert(subject.estimator->listed);
    }
  }
  Used used;
  for (const EstimatorEntry& entry : run.suite.estimators) {
    const auto prepared = run.estimators.find(entry.name);
    if (prepared == run.estimators.end() || prepared->second.setup->is_reference()) continue;
    if (wanted.contains(entry.name)) used.push_back(&prepared->second);
  }
  return used;
}

/// The estimators, and those at the points of the chosen tests' sweeps.
Used with_sweeps(Used estimators, const SuiteRun& run) {
  std::set<std::string> known;
  for (const Question& question : run.questions) {
    for (const Subject& subject : question.subjects) {
      if (!question.chosen || !subject.own || !known.insert(subject.own->name).second) continue;
      estimators.push_back(subject.own.get());
    }
  }
  return estimators;
}

/// The pilots of a suite's estimators: first of pictures that are read row by row, then the others.
Pilots piloted(const SuiteRun& run, const RunOptions& options, Progress& progress) {
  Used used = run.used;
  Pilots pilots;
  for (const Question* const question : streamed(run.questions)) {
    if (!question->chosen) continue;
    StreamedPictures taken = stream_pictures(*question, progress);
    stop_if_interrupted();
    if (taken.pilots.empty()) {
      require_memory(run.estimators, {}, available_bytes(), taken.fault);
    } else {
      for (const Subject& side : question->subjects) std::erase(used, side.estimator);
    }
    pilots.merge(std::move(taken.pilots));
  }
  if (used.empty()) return pilots;
  pilots.merge(run_pilots(with_sweeps(std::move(used), run), run.questions, run.seed,
                          *executor_of(options), progress));
  return pilots;
}

void plan_tests(SuiteRun& run, const RunOptions& options, Progress& progress) {
  std::erase_if(run.untested,
                [&](const Untested& each) { return !selects(options.selection, *each.test); });
  std::vector<Question>& questions = run.questions;
  if (std::ranges::none_of(questions, &Question::chosen)) return;
  run.used = used_by(run);
  const std::vector<FamilyPlace> place = places(run.suite, questions);
  run.pilots = piloted(run, options, progress);
  stop_if_interrupted();
  const Primaries primaries = choose_primaries(questions, place, run.pilots);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (!questions[i].chosen) continue;
    run.tests.push_back(
        {.suite_budget = run.suite.budget ? &*run.suite.budget : nullptr,
         .outcome = plan_test(std::move(questions[i]), place[i], run.pilots, primaries)});
  }
  std::erase_if(questions, [](const Question& each) { return each.chosen; });
}

void plan_pools(SuiteRun& run, Pools& pools) {
  for (TestWork& work : run.tests) {
    work.pools = pools.for_question(work.outcome.question, work.outcome.plan, run.seed, run.pilots);
  }
}

/// Prepares the estimators and returns faults. A refusal by an estimator is the user's mistake; any
/// other exception is the estimator's fault.
std::map<std::string, Fault> prepare_estimators(SuiteRun& run, Mistakes& mistakes) {
  std::map<std::string, Fault> faults;
  for (const EstimatorEntry& entry : run.suite.estimators) {
    try {
      mistakes.attempt(
          [&] { run.estimators.emplace(entry.name, prepare(entry, run.suite.folder)); });
    } catch (...) {
      faults.emplace(entry.name, Fault{.words = words_of(std::current_exception())});
    }
  }
  share_random_numbers(run.suite, run.estimators);
  return faults;
}

void note_unused(const Suite& suite) {
  std::vector<std::string> unused = mapped(suite.estimators, &EstimatorEntry::name);
  for (const TestEntry& test : suite.tests) {
    for (const Source& source : sources_of(test)) std::erase(unused, source.estimator);
  }
  if (unused.empty()) return;
  notice(fmt::format("no test of `{}` names its estimator{} `{}`", suite.name,
                     unused.size() == 1 ? "" : "s", fmt::join(unused, "`, `")));
}

void ask_test(SuiteRun& run, TestEntry& test, const std::map<std::string, Fault>& faults,
              Mistakes& mistakes) {
  std::string why;
  for (const Source& source : sources_of(test)) {
    const auto fault = faults.find(source.estimator);
    if (fault == faults.end() || !why.empty()) continue;
    why = fmt::format("`{}` cannot be prepared: {}", source.estimator, fault->second.words);
  }
  const auto is_there = [&](const Source& x) { return run.estimators.contains(x.estimator); };
  try {
    if (std::ranges::all_of(sources_of(test), is_there))
      mistakes.attempt([&] {
        run.questions.push_back(ask_as_written(test, run.estimators, run.seed));
        if (test.method) find_method(run.questions.back(), *test.method);
      });
  } catch (...) {  // at another value of a sweep
    why = "an estimator cannot be prepared: " + words_of(std::current_exception());
  }
  if (why.empty()) return;
  run.untested.push_back({&test, reports::Verdict::error, std::move(why)});
}

/// Finds all mistakes of the user before anything is sampled. Prepares nothing of a skipped suite.
std::unique_ptr<SuiteRun> prepare_suite(const Suite& suite, const RunOptions& options,
                                        Mistakes& mistakes) {
  auto run = std::make_unique<SuiteRun>();
  run->suite = suite;
  if (options.alpha) run->suite.alpha = *options.alpha;
  share_budget(run->suite);
  run->seed = options.seed.value_or(suite.seed.value_or(1));
  for (const std::string& program : suite.needs) {
    if (!foreign::program_path(program, suite.folder).empty()) continue;
    const std::string lack = fmt::format("needs the program `{}`, which is not installed", program);
    for (const TestEntry& test : run->suite.tests) {
      run->untested.push_back({&test, reports::Verdict::skipped, lack});
    }
    return run;
  }
  const std::map<std::string, Fault> faults = prepare_estimators(*run, mistakes);
  for (TestEntry& test : run->suite.tests) ask_test(*run, test, faults, mistakes);
  if (mistakes.any()) return run;
  for (Question& each : run->questions) each.chosen = selects(options.selection, *each.test);
  note_unused(run->suite);
  coarsen(run->suite, options);
  require_memory(run->estimators, streamed(run->questions), available_bytes());
  return run;
}

using Missing = std::map<std::string, foreign::MissingFile>;  // by file

void add_missing(const Pool& pool, std::uint64_t count, Missing& missing) {
  const auto* const rendered = dynamic_cast<const foreign::Rendered*>(pool.setup().get());
  if (rendered == nullptr) return;
  for (foreign::MissingFile& each : rendered->missing(pool.key(), count, pool.primaries())) {
    missing.emplace(each.file, std::move(each));
  }
}

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

/// Leaves the planned tests of shard I of N, counted from 1; `elsewhere` names the others. Every
/// shard draws the pilots of all selected tests and deals the tests in the same way, from the
/// suites and the seed alone.
///
/// A test costs the expected observations of its streams, each by its rays and samples in the
/// pilot. Tests of one stream share their observations: the longest prefix counts. The dearest test
/// is dealt first (Graham 1969). It goes where it adds least, among the shards that stay near a
/// fair part. If none does, it goes to the shard that has least to draw with it.
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

}  // namespace

std::vector<foreign::MissingFile> missing_files(const std::vector<Suite>& suites,
                                                const RunOptions& options, Progress& progress) {
  Missing all;
  for (const Suite& suite : suites) {
    Mistakes mistakes;
    const std::unique_ptr<SuiteRun> run = prepare_suite(suite, options, mistakes);
    mistakes.refuse_any();
    const Used used = with_sweeps(used_by(*run), *run);
    Missing missing;
    for (const auto& [name, pool] : pilot_pools(used, run->questions, run->seed)) {
      add_missing(*pool, pool->requested(), missing);
    }
    if (missing.empty()) {
      Pools pools;
      plan_tests(*run, options, progress);
      plan_pools(*run, pools);
      for (const TestWork& work : run->tests) {
        const TestOutcome& outcome = work.outcome;
        for (std::size_t i = 0; i < work.pools.size(); ++i) {
          const Subject& side = outcome.question.subjects[i];
          add_missing(*work.pools[i], side.secondaries(outcome.plan.most_secondaries()), missing);
        }
      }
    }
    all.merge(missing);
  }
  return mapped(all, [](const auto& each) { return each.second; });
}

NamedSetups setups_of(const PlannedRun& run) {
  NamedSetups setups;
  for (std::size_t i = 0; i < run.suites.size(); ++i) {
    for (const auto& [name, estimator] : run.suites[i]->estimators) {
      setups.emplace_back(fmt::format("{} {}", i, name), estimator.setup);
    }
    for (const Question& question : run.suites[i]->questions) {
      for (std::size_t k = 0; k < question.subjects.size(); ++k) {
        setups.emplace_back(fmt::format("{} {} {}", i, question.test->id, k),
                            question.subjects[k].setup);
      }
    }
  }
  return setups;
}

PlannedRun prepare_run(const std::vector<Suite>& suites, const RunOptions& options) {
  Mistakes mistakes;
  PlannedRun run{.suites = mapped(suites, [&](const Suite& suite) {
                   return prepare_suite(suite, options, mistakes);
                 })};
  mistakes.refuse_any();
  return run;
}

PlannedRun plan_run(const std::vector<Suite>& suites, const RunOptions& options,
                    Progress& progress) {
  PlannedRun planned = prepare_run(suites, options);
  executor_of(options)->introduce(setups_of(planned));
  for (auto& run : planned.suites) plan_tests(*run, options, progress);
  if (options.shard) keep_shard(planned.suites, *options.shard);
  for (auto& run : planned.suites) plan_pools(*run, planned.pools);
  return planned;
}

}  // namespace assay::harness
