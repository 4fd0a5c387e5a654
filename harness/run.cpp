#include "harness/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <set>
#include <stdexcept>

#include "harness/holm_verdict.h"
#include "harness/interrupt.h"
#include "harness/looks.h"
#include "harness/plan.h"
#include "harness/pools.h"
#include "harness/record_of.h"
#include "harness/scheduler.h"

namespace assay::harness {
namespace {

// For the suite's picture, of an estimator that no selected mean or variance claim draws.
constexpr std::uint64_t picture_secondaries = 1000;
constexpr std::uint64_t picture_primaries = 64;

bool selected(const TestEntry& test, std::size_t index, const RunOptions& options) {
  if (options.shard && index % options.shard->second != options.shard->first - 1) return false;
  return options.filter.empty() || matches(options.filter, test.id);
}

/// The suite as this run wants it.
Suite adjusted(Suite suite, const RunOptions& options) {
  if (options.alpha) suite.alpha = *options.alpha;
  for (TestEntry& test : suite.tests) {
    if (!test.detect) continue;
    test.detect->value *= options.coarsen;
    if (test.allow && test.detect->value <= test.allow->value) {
      throw InputError(test.where, fmt::format("`--coarsen {:g}` brings `detect` down to `allow`; "
                                               "`detect` must stay above it",
                                               options.coarsen));
    }
  }
  return suite;
}

/// Estimators that a set of questions is about, in the suite's order.
std::vector<const PreparedEstimator*> used_by(const std::vector<Question>& questions,
                                              const std::vector<bool>& chosen,
                                              const SuiteRun& run) {
  std::vector<const PreparedEstimator*> used;
  const bool all = std::all_of(chosen.begin(), chosen.end(), [](bool c) { return c; });
  for (const EstimatorEntry& entry : run.suite.estimators) {
    const PreparedEstimator& estimator = run.estimators.at(entry.name);
    bool wanted = all;
    for (std::size_t i = 0; i < questions.size(); ++i) {
      for (const Subject& subject : questions[i].subjects) {
        wanted = wanted || (chosen[i] && subject.estimator->listed == estimator.name);
      }
    }
    if (wanted) used.push_back(&estimator);
  }
  return used;
}

/// And the points of their sweeps.
std::vector<const PreparedEstimator*> with_sweeps(std::vector<const PreparedEstimator*> estimators,
                                                  const std::vector<Question>& questions,
                                                  const std::vector<bool>& chosen) {
  std::set<std::string> known;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    for (const Subject& subject : questions[i].subjects) {
      if (!chosen[i] || !subject.own || !known.insert(subject.own->name).second) continue;
      estimators.push_back(subject.own.get());
    }
  }
  return estimators;
}

/// Names of the estimators whose costs some claim is about.
std::set<std::string> costly(const std::vector<Question>& questions) {
  std::set<std::string> names;
  for (const Question& question : questions) {
    if (methods_for(question).front().keeps != Keeps::costs) continue;
    for (const Subject& subject : question.subjects) names.insert(subject.estimator->name);
  }
  return names;
}

void plan_picture(SuiteRun& run, const std::vector<const PreparedEstimator*>& used,
                  const Primaries& primaries, const Pilots& pilots, Pools& pools) {
  for (const PreparedEstimator* estimator : used) {
    const auto found = primaries.find(estimator->name);
    const std::uint64_t automatic = !estimator->entry->information.averages ? 1
                                    : found != primaries.end()              ? found->second
                                                                            : picture_primaries;
    const auto pool =
        pools.for_picture(*estimator, estimator->primaries.value_or(automatic), run.seed, pilots);
    if (!pool->is_marked()) {
      pool->request(estimator->setup->observations().value_or(picture_secondaries));
    }
    run.pictures.push_back({estimator, pool});
  }
}

/// Pools are short then, and must not be read.
void stop_if_interrupted() {
  if (interrupted()) throw std::runtime_error("interrupted; nothing is written");
}

void plan_suite(SuiteRun& run, const RunOptions& options, Pools& pools, Progress& progress) {
  std::vector<Question> questions;
  std::vector<bool> chosen;
  for (std::size_t i = 0; i < run.suite.tests.size(); ++i) {
    questions.push_back(ask(run.suite.tests[i], run.estimators, run.seed));
    chosen.push_back(selected(run.suite.tests[i], i, options));
  }
  if (std::none_of(chosen.begin(), chosen.end(), [](bool c) { return c; })) return;
  const std::vector<FamilyPlace> place = places(run.suite, questions);
  const auto used = used_by(questions, chosen, run);
  const Pilots pilots = run_pilots(
      with_sweeps(used, questions, chosen),
      {.seed = run.seed, .threads = options.threads, .with_cost = costly(questions)}, progress);
  stop_if_interrupted();
  const Primaries primaries = choose_primaries(questions, place, pilots);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (!chosen[i]) continue;
    Plan plan = plan_test(questions[i], place[i], pilots, primaries);
    TestWork work{
        .outcome = {.question = questions[i], .place = place[i], .plan = std::move(plan)}};
    for (std::size_t subject = 0; subject < work.outcome.question.subjects.size(); ++subject) {
      work.pools.push_back(
          pools.for_subject(work.outcome.question, subject, work.outcome.plan, run.seed, pilots));
    }
    run.tests.push_back(std::move(work));
  }
  plan_picture(run, used, primaries, pilots, pools);
}

void judge_family(SuiteRun& run, const RunOptions& options) {
  std::vector<TestWork*> tests;
  for (TestWork& work : run.tests) tests.push_back(&work);
  if (run.tests.size() == run.suite.tests.size() && !options.shard) {
    apply_holm(tests, run.suite.alpha);
    run.holm = true;
  }
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[sizeof "2000-01-01T00:00:00Z"];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace

reports::Record run(const std::vector<Suite>& suites, const RunOptions& options,
                    Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::string started = utc_now();
  // Everything a user may have got wrong is found here, before anything is sampled.
  std::vector<std::unique_ptr<SuiteRun>> runs;
  for (const Suite& suite : suites) {
    auto run = std::make_unique<SuiteRun>();
    run->suite = adjusted(suite, options);
    run->seed = options.seed.value_or(suite.seed.value_or(1));
    run->estimators = prepare_all(run->suite);
    for (const TestEntry& test : run->suite.tests) {
      const Question question = ask(test, run->estimators, run->seed);
      if (test.method) find_method(question, *test.method);
    }
    runs.push_back(std::move(run));
  }
  Pools pools;
  for (auto& run : runs) plan_suite(*run, options, pools, progress);
  std::vector<TestWork*> tests;
  for (auto& run : runs) {
    for (TestWork& work : run->tests) tests.push_back(&work);
  }
  sample_in_looks(tests, pools.all(), options.threads, progress);
  stop_if_interrupted();
  for (auto& run : runs) judge_family(*run, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  reports::Record record = record_of(runs, options);
  record.started = started;
  record.seconds = elapsed.count();
  return record;
}

int exit_code(const reports::Record& record, InconclusivePolicy policy) {
  const reports::Tally tally = reports::tally(record);
  const int undecided = policy == InconclusivePolicy::report ? tally.inconclusive : 0;
  const int failed = tally.failed + (policy == InconclusivePolicy::fail ? tally.inconclusive : 0);
  if (tally.passed + tally.failed + tally.inconclusive + tally.skipped == 0) return 4;
  if (failed > 0) return 1;
  if (undecided > 0) return 3;
  if (tally.passed + tally.inconclusive == 0) return 77;
  return 0;
}

bool matches(std::string_view glob, std::string_view text) {
  if (glob.empty()) return text.empty();
  if (glob[0] == '*') {
    return matches(glob.substr(1), text) || (!text.empty() && matches(glob, text.substr(1)));
  }
  if (text.empty() || (glob[0] != '?' && glob[0] != text[0])) return false;
  return matches(glob.substr(1), text.substr(1));
}

}  // namespace assay::harness
