#include "harness/calibration/calibrate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "harness/base/interrupt.h"
#include "harness/base/terminal.h"
#include "harness/calibration/calibration_runs.h"
#include "harness/record/environment.h"
#include "reports/report_formats.h"
#include "stats/means/binomial.h"

namespace assay::harness {
namespace {

using reports::CalibrationCell;
using reports::Rate;
using reports::VerdictRates;

/// Counts of one law. Their limits need the total number of cells.
struct Measured {
  double alpha;
  std::string law;
  CalibrationCase of;
  CaseCounts counts;

  const VerdictCounts& at(Trial trial) const { return counts[static_cast<std::size_t>(trial)]; }
};

/// Exact limits, each side missing with probability `error`.
Rate rate_of(std::uint64_t count, std::uint64_t runs, double error) {
  if (runs == 0) return {};
  const stats::Interval limits =
      stats::clopper_pearson({.successes = count, .trials = runs}, 1 - 2 * error);
  return {.count = count, .runs = runs, .low = limits.low, .high = limits.high};
}

double mean_observations(const VerdictCounts& counts) {
  if (counts.runs == 0) return 0;
  return static_cast<double>(counts.observations) / static_cast<double>(counts.runs);
}

std::vector<reports::MethodRuns> by_frequency(const VerdictCounts& counts) {
  std::vector<reports::MethodRuns> methods;
  for (const auto& [method, runs] : counts.methods) methods.push_back({method, runs});
  std::ranges::stable_sort(methods, std::greater{}, &reports::MethodRuns::runs);
  return methods;
}

VerdictRates rates_of(const VerdictCounts& counts, double error) {
  const auto rate = [&](std::uint64_t count) { return rate_of(count, counts.runs, error); };
  return {.pass = rate(counts.passed),
          .fail = rate(counts.failed),
          .inconclusive = rate(counts.inconclusive),
          .invalid = rate(counts.invalid),
          .red = rate(counts.red),
          .observations = mean_observations(counts),
          .by = by_frequency(counts)};
}

CalibrationCell cell_of(const Measured& measured, double error) {
  const VerdictCounts& alone = measured.at(Trial::alone);
  return {.method = measured.of.method,
          .question = measured.of.question,
          .law = measured.law,
          .alpha = measured.alpha,
          .proof = measured.of.proof,
          .holds = rates_of(measured.at(Trial::holds), error),
          .off = rates_of(measured.at(Trial::off), error),
          .alone = rates_of(alone, error),
          .alone_not_red = rate_of(alone.mistaken_not_red, alone.runs, error)};
}

void measure(const CalibrationBench& bench, const CalibrationRuns& options,
             const std::function<void(std::uint64_t)>& done, std::vector<Measured>& all) {
  const auto counts = run_calibration(bench, options, done);
  stop_if_interrupted();
  for (std::size_t a = 0; a < options.alphas.size(); ++a) {
    for (std::size_t c = 0; c < bench.cases.size(); ++c) {
      all.push_back({options.alphas[a], bench.law, bench.cases[c], counts[a][c]});
    }
  }
}

/// Groups cells by alpha, then method and question. Alphas, questions and laws keep their order.
void group(std::vector<Measured>& all, const std::vector<double>& alphas) {
  std::vector<std::string> questions;
  for (const Measured& each : all) {
    const std::string key = each.of.method + each.of.question;
    if (std::find(questions.begin(), questions.end(), key) == questions.end()) {
      questions.push_back(key);
    }
  }
  const auto rank = [&](const Measured& each) {
    const auto alpha = std::find(alphas.begin(), alphas.end(), each.alpha);
    const auto question =
        std::find(questions.begin(), questions.end(), each.of.method + each.of.question);
    return std::pair(alpha - alphas.begin(), question - questions.begin());
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Measured& a, const Measured& b) { return rank(a) < rank(b); });
}

/// Drops repeated levels and laws, which would be measured twice.
template <class T>
void refuse_twice(const char* option, const std::vector<T>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(values.begin(), end, values[i]) == end) continue;
    throw InputError({}, fmt::format("{} {} is given twice", option, values[i]));
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
  const CalibrationRuns options{
      .alphas = arguments.alphas.empty() ? std::vector{0.05, 0.01, 0.001} : arguments.alphas,
      .runs = arguments.runs,
      .seed = arguments.seed,
      .threads = arguments.threads};
  for (const std::string& method : arguments.methods) require_calibrated(method);
  refuse_twice("METHOD", arguments.methods);
  std::vector<Measured> all;
  progress.begin({"calibration", laws.size() * arguments.runs, "runs"});
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const CalibrationBench bench(
        {.law = laws[i], .methods = arguments.methods, .samples = arguments.samples});
    if (bench.cases.empty()) continue;
    measure(
        bench, options, [&](std::uint64_t done) { progress.advance(i * arguments.runs + done); },
        all);
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
