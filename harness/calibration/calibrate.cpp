#include "harness/calibration/calibrate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "harness/base/interrupt.h"
#include "harness/base/parallel.h"
#include "harness/base/terminal.h"
#include "harness/calibration/calibration_cases.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/plan.h"
#include "harness/record/record_of.h"
#include "harness/run/looks.h"
#include "harness/run/pools.h"
#include "harness/theta/ask.h"
#include "reports/report_formats.h"
#include "stats/means/binomial.h"

namespace assay::harness {
namespace {

using reports::CalibrationCell;
using reports::Rate;
using reports::Verdict;
using reports::VerdictRates;

constexpr double usual_beta = 0.01;

/// Outcomes of one test over the seeds. They are sums of whole numbers, so the order of seeds does
/// not matter.
struct VerdictCounts {
  std::uint64_t runs = 0;
  std::map<Verdict, std::uint64_t> verdicts = {};  ///< Errors and refusals count as invalid.
  std::uint64_t red = 0;
  std::uint64_t mistaken_not_red = 0;  ///< Mistakes in runs without a red gate.
  std::uint64_t observations = 0;      ///< Sum of each subject's at the last look taken.
  std::map<std::string, std::uint64_t> methods = {};  ///< Number of runs that each method judged.
};

/// A case on one law at one alpha. The limits of its rates need the total number of cells.
struct Measured {
  double alpha;
  std::string law;
  CalibrationCase of;
  VerdictCounts holds = {};
  VerdictCounts off = {};
  VerdictCounts alone = {};
};

/// One test of a case, as a suite of its own.
struct Item {
  VerdictCounts& counts;
  bool proof;
  Suite suite;
};

std::vector<Item> items_of(std::vector<Measured>& all) {
  std::vector<Item> items;
  for (Measured& each : all) {
    const auto add = [&](const std::optional<TestEntry>& test, VerdictCounts& counts) {
      if (!test) return;
      // A proof errs by passing, so its level is beta.
      Suite suite{.name = "calibration",
                  .stem = "calibration",
                  .alpha = each.alpha,
                  .beta = each.of.proof ? each.alpha : usual_beta};
      suite.tests = {*test};
      items.push_back({counts, each.of.proof, std::move(suite)});
    };
    add(each.of.holds, each.holds);
    add(each.of.off, each.off);
    add(each.of.alone, each.alone);
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

void tally(const TestOutcome& outcome, bool proof, VerdictCounts& counts) {
  const auto any_red = [](const std::vector<Gate>& gates) {
    return std::ranges::any_of(gates, &Gate::is_red);
  };
  const bool red = any_red(outcome.plan.gates) || any_red(outcome.gates);
  const bool mistaken = outcome.verdict == (proof ? Verdict::pass : Verdict::fail);
  ++counts.verdicts[outcome.verdict == Verdict::error ? Verdict::invalid : outcome.verdict];
  counts.red += red ? 1 : 0;
  counts.mistaken_not_red += mistaken && !red ? 1 : 0;
  counts.observations += outcome.secondaries();
  ++counts.methods[outcome.plan.method.name];
}

/// All items see the same observations.
void run_once(const CalibrationBench& bench, const std::vector<Item>& items, std::uint64_t seed,
              std::mutex& counting) {
  std::vector<Question> questions;
  for (const Item& item : items) {
    questions.push_back(ask(item.suite.tests[0], bench.estimators, seed));
  }
  const Pilots pilots = pilots_of(questions, seed);
  Pools pools;
  std::vector<std::optional<TestWork>> works(items.size());
  std::vector<TestWork*> open;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::vector<FamilyPlace> place = places(items[i].suite, {questions[i]});
    try {
      Plan plan = plan_test(questions[i], place[0], pilots,
                            choose_primaries({questions[i]}, place, pilots));
      works[i] = TestWork{
          .outcome = {.question = questions[i], .place = place[0], .plan = std::move(plan)},
          .verdict_only = true};
    } catch (const InputError&) {
      continue;  // a run would stop before sampling
    }
    TestOutcome& outcome = works[i]->outcome;
    works[i]->pools = pools.for_question(outcome.question, outcome.plan, seed, pilots);
    open.push_back(&*works[i]);
  }
  leave_out_pictures(pools);
  Silence silence;
  sample_in_looks(open, pools.all(), {.executor = threads(1)}, silence);
  if (interrupted()) return;
  const std::lock_guard lock(counting);
  for (std::size_t i = 0; i < items.size(); ++i) {
    VerdictCounts& counts = items[i].counts;
    ++counts.runs;
    if (works[i]) {
      tally(works[i]->outcome, items[i].proof, counts);
    } else {
      ++counts.verdicts[Verdict::invalid];
    }
  }
}

/// The cases of one law, by alpha. `done` gets the number of finished runs, on the calling thread.
std::vector<Measured> measure(const CalibrationBench& bench, const CalibrateArguments& arguments,
                              const std::function<void(std::uint64_t)>& done) {
  std::vector<Measured> all;
  for (const double alpha : arguments.alphas) {
    for (const CalibrationCase& each : bench.cases) all.push_back({alpha, bench.law, each});
  }
  const std::vector<Item> items = items_of(all);
  std::atomic<std::uint64_t> next{0};
  std::mutex mutex;
  std::exception_ptr trouble;
  const auto work = [&](bool tells) {
    try {
      for (std::uint64_t run = next++; run < arguments.runs && !interrupted(); run = next++) {
        run_once(bench, items, arguments.seed + run, mutex);
        if (tells) done(std::min(next.load(), arguments.runs));
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      trouble = std::current_exception();
      next = arguments.runs;
    }
  };
  std::vector<std::jthread> helpers;
  for (unsigned i = 1; i < threads_of(arguments.threads); ++i) helpers.emplace_back(work, false);
  work(true);
  helpers.clear();
  if (trouble) std::rethrow_exception(trouble);
  stop_if_interrupted();
  return all;
}

/// Exact limits, each side missing with probability `error`.
Rate rate_of(std::uint64_t count, std::uint64_t runs, double error) {
  if (runs == 0) return {};
  const stats::Interval limits =
      stats::clopper_pearson({.successes = count, .trials = runs}, 1 - 2 * error);
  return {.count = count, .runs = runs, .low = limits.low, .high = limits.high};
}

std::vector<reports::MethodRuns> by_frequency(const VerdictCounts& counts) {
  std::vector<reports::MethodRuns> methods;
  for (const auto& [method, runs] : counts.methods) methods.push_back({method, runs});
  std::ranges::stable_sort(methods, std::greater{}, &reports::MethodRuns::runs);
  return methods;
}

VerdictRates rates_of(VerdictCounts counts, double error) {
  const auto rate = [&](Verdict verdict) {
    return rate_of(counts.verdicts[verdict], counts.runs, error);
  };
  const double runs = static_cast<double>(std::max<std::uint64_t>(counts.runs, 1));
  return {.pass = rate(Verdict::pass),
          .fail = rate(Verdict::fail),
          .inconclusive = rate(Verdict::inconclusive),
          .invalid = rate(Verdict::invalid),
          .red = rate_of(counts.red, counts.runs, error),
          .observations = static_cast<double>(counts.observations) / runs,
          .by = by_frequency(counts)};
}

CalibrationCell cell_of(const Measured& measured, double error) {
  const VerdictCounts& alone = measured.alone;
  return {.method = measured.of.method,
          .question = measured.of.question,
          .law = measured.law,
          .alpha = measured.alpha,
          .proof = measured.of.proof,
          .holds = rates_of(measured.holds, error),
          .off = rates_of(measured.off, error),
          .alone = rates_of(alone, error),
          .alone_not_red = rate_of(alone.mistaken_not_red, alone.runs, error)};
}

/// Groups cells by alpha, then method and question. Alphas, questions and laws keep their order.
void group(std::vector<Measured>& all, const std::vector<double>& alphas) {
  const auto question = [](const Measured& each) { return each.of.method + each.of.question; };
  std::map<std::string, std::size_t> questions;
  for (const Measured& each : all) questions.try_emplace(question(each), questions.size());
  std::ranges::stable_sort(all, {}, [&](const Measured& each) {
    return std::pair(std::ranges::find(alphas, each.alpha), questions.at(question(each)));
  });
}

/// Refuses repeated levels and laws, which would be measured twice.
template <class T>
void refuse_twice(const char* option, const std::vector<T>& values) {
  for (auto each = values.begin(); each != values.end(); ++each) {
    if (std::find(values.begin(), each, *each) == each) continue;
    throw InputError({}, fmt::format("{} {} is given twice", option, *each));
  }
}

}  // namespace

reports::Calibration calibration(const CalibrateArguments& arguments, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  reports::Calibration result{.tool = this_tool(),
                              .environment = this_environment(arguments.threads),
                              .seed = arguments.seed,
                              .runs = arguments.runs,
                              .started = utc_now(),
                              .detect = calibration_effects()};
  std::vector<std::string> laws;
  for (const std::string& law : arguments.laws) laws.push_back(calibration_law(law));
  std::vector<std::string> without_blanks = laws;
  for (std::string& law : without_blanks) std::erase(law, ' ');
  refuse_twice("--law", without_blanks);
  refuse_twice("--alpha", arguments.alphas);
  if (laws.empty()) laws = calibration_laws();
  CalibrateArguments options = arguments;
  if (options.alphas.empty()) options.alphas = {0.05, 0.01, 0.001};
  for (const std::string& method : arguments.methods) require_calibrated(method);
  refuse_twice("METHOD", arguments.methods);
  std::vector<Measured> all;
  progress.begin({"calibration", laws.size() * arguments.runs, "runs"});
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const CalibrationBench bench(
        {.law = laws[i], .methods = arguments.methods, .samples = arguments.samples});
    if (bench.cases.empty()) continue;
    std::ranges::move(
        measure(bench, options,
                [&](std::uint64_t done) { progress.advance(i * arguments.runs + done); }),
        std::back_inserter(all));
  }
  progress.end();
  if (all.empty()) {
    throw InputError({}, fmt::format("no question suits `{}` on these laws",
                                     fmt::join(arguments.methods, "`, `")));
  }
  group(all, options.alphas);
  const double error = result.error / static_cast<double>(all.size());
  for (const Measured& each : all) result.cells.push_back(cell_of(each, error));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

int calibrate(const CalibrateArguments& arguments, const Output& output) {
  require_writable(output, {});
  const std::unique_ptr<Progress> progress = make_progress(output.quiet);
  const reports::Calibration measured = calibration(arguments, *progress);
  write_reports(output, [&](const ReportRequest& request, const reports::ConsoleOptions&) {
    return reports::report_format(request.kind).of_calibration(measured);
  });
  return reports::defects(measured) == 0 ? 0 : 1;
}

}  // namespace assay::harness
