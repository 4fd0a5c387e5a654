#include "harness/calibration/calibrate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "harness/base/terminal.h"
#include "harness/language/laws.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"
#include "harness/plan/plan.h"
#include "harness/record/record_of.h"
#include "harness/run/planned_run.h"
#include "harness/sampling/prepare.h"
#include "harness/suite/suite.h"
#include "harness/theta/ask.h"
#include "reports/report_formats.h"
#include "stats/means/binomial.h"

namespace assay::harness {
namespace {

// ---- Cases: of each law claims that hold exactly, claims that are off by `detect`, and each
// method alone.

// The `detect` of each kind of question. Means: standard deviations. Variances and costs: a ratio.
// Laws: the largest distance of distribution functions. Cells: Cohen's w. A slope: its own units.
// Images, whose pixels' means are about 6: each pixel's bias and its share of them.
constexpr double mean_effect = 0.15;
constexpr double variance_effect = 0.3;
constexpr double law_effect = 0.1;
constexpr double cell_effect = 0.15;
constexpr double slope_effect = 0.2;
constexpr double image_bias = 0.35;
constexpr double image_part = 0.06;
constexpr std::uint64_t classical_samples = 1000;

struct Facts {
  std::string law;
  double mean = 0;
  double deviation = 0;
  double low = 0;
  double high = 0;
  bool has_density = false;
  double shift_at_law_effect = 0;  ///< 0 if there is no density

  double variance() const { return deviation * deviation; }
  bool two_valued() const { return law.starts_with("bernoulli("); }
  bool bounded() const { return std::isfinite(low) && std::isfinite(high); }
  double shift() const { return mean_effect * deviation; }
};

EstimatorEntry entry_of(const std::string& name, const std::string& plugin, const std::string& law,
                        const std::vector<std::pair<std::string, double>>& numbers = {},
                        std::uint64_t primaries = 1) {
  std::vector<Value::Member> given{{"law", Value::scalar(law)}};
  for (const auto& [key, number] : numbers) {
    given.emplace_back(key, Value::scalar(fmt::format("{:.17g}", number)));
  }
  return {.name = name,
          .plugin = plugin,
          .parameters = Value::map(std::move(given)),
          .primaries = primaries};
}

EstimatorEntry drawn_from(const std::string& law, const std::string& name, double shift = 0,
                          double scale = 1) {
  return entry_of(name, "analytic/law", law, {{"shift", shift}, {"scale", scale}});
}

/// 64 pixels with means from 1 to 10, each with this law's noise.
EstimatorEntry picture_of(const std::string& law, const std::string& name) {
  return entry_of(name, "analytic/ramp", law, {{"width", 8}, {"height", 8}}, 4);
}

double shift_at_law_effect(const Facts& facts) {
  const Claim claim = parse_claim("distribution(x) == " + facts.law, {});
  const Law& law = std::get<Law>(claim.right);
  const std::function<double(double)> cdf = find_law(law.name)->cdf(law.arguments);
  const auto distance_at = [&](double shift) {  // sup over x of P(x - shift < X <= x)
    constexpr int steps = 2000;
    double largest = 0;
    for (int i = 0; i <= steps; ++i) {
      const double x = facts.mean + facts.deviation * (16.0 * i / steps - 8);
      largest = std::max(largest, cdf(x) - cdf(x - shift));
    }
    return largest;
  };
  double low = 0;
  double high = facts.deviation;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (distance_at(middle) < law_effect ? low : high) = middle;
  }
  return high;
}

Facts facts_of(const std::string& law) {
  const PreparedEstimator x = prepare(drawn_from(law, "x"), ".");
  const Channel channel = x.setup->channel(0);
  if (!channel.mean || !channel.variance) {
    refuse({}, "`{}` has no variance, so no method promises anything", law);
  }
  return {.law = law,
          .mean = *channel.mean,
          .deviation = std::sqrt(*channel.variance),
          .low = channel.low,
          .high = channel.high,
          .has_density = !x.setup->samplers().empty()};
}

/// A case as text, with numbers of the law by their names.
struct Draft {
  std::string method;
  std::string question;
  std::string holds;
  std::string off = "";
  std::string detect = "";
  bool is_default = true;
  std::function<bool(const Facts&)> suits = {};  ///< Null: any law.
  std::uint64_t alone = classical_samples;       ///< Observations of a method alone.
  TestKeys keys = {};                            ///< Other keys of its tests.
};

const std::vector<Draft>& all_drafts() {
  static const TestKeys in_samples{{"cost", "samples"}};
  static const TestKeys over_scales{{"over", "{scale: [1, 2, 4, 8]}"}};
  static const std::vector<Draft> drafts{
      {"t", "mean == number", "mean(x) == {mean}", "mean(x) == {less}", "{shift}"},
      {"t", "mean <= number", "mean(x) <= {mean}", "mean(x) <= {less}", "{shift}"},
      {"t", "mean >= number", "mean(x) >= {mean}", "mean(x) >= {more}", "{shift}"},
      {"welch", "mean == mean", "mean(x) == mean(y)", "mean(shifted) == mean(y)", "{shift}"},
      {"tost", "mean within x of number", "mean(x) within {shift} of {mean}",
       "mean(x) within {shift} of {less}"},
      {"skewness-corrected-t", "mean == number", "mean(x) == {mean}", "", "", false},
      {"binomial", "mean == number", "mean(x) == {mean}", "", "", false, &Facts::two_valued},
      {"betting", "mean == number", "mean(x) == {mean}", "", "", false, &Facts::bounded},
      {"betting", "mean <= number", "mean(x) <= {mean}", "", "", false,
       [](const Facts& f) { return std::isfinite(f.low) && !f.bounded(); }},
      {"chi-square", "variance == number", "variance(x) == {variance}", "variance(x) == {smaller}",
       "{variance_effect}%"},
      {"chi-square", "variance <= number", "variance(x) <= {variance}", "variance(x) <= {smaller}",
       "{variance_effect}%"},
      {"F", "variance == variance", "variance(x) == variance(y)",
       "variance(x) == {factor} * variance(y)", "{variance_effect}%"},
      {"influence-t", "variance == number", "variance(x) == {variance}", "", "", false},
      {"influence-t", "variance == variance", "variance(x) == variance(y)", "", "", false},
      {"influence-t", "total variance == number", "total_variance(x) == {variance}",
       "total_variance(x) == {smaller}", "{variance_effect}%"},
      {"influence-t", "efficiency == efficiency", "efficiency(x) == efficiency(y)",
       "efficiency(y) == efficiency(scaled)", "{variance_effect}%", true, nullptr,
       classical_samples, in_samples},
      {"influence-t", "efficiencies at random costs",
       "efficiency(costly) == efficiency(other_costly)", "", "{variance_effect}%"},
      {"influence-t", "cost == cost", "cost(costly) == cost(other_costly)",
       "cost(costly) == {factor} * cost(other_costly)", "{variance_effect}%"},
      {"influence-t", "cost <= cost", "cost(costly) <= cost(other_costly)",
       "cost(costly) <= {inverse} * cost(other_costly)", "{variance_effect}%"},
      {"slope", "slope of variance", "slope(variance(x)) == 2", "slope(variance(x)) == {slope}",
       "{slope_effect}", true, nullptr, classical_samples, over_scales},
      {"ks", "law == law given", "distribution(x) == {law}", "distribution(moved) == {law}",
       "{law_effect}", true, &Facts::has_density},
      {"ks", "law == law", "distribution(x) == distribution(y)",
       "distribution(moved) == distribution(y)", "{law_effect}", true, &Facts::has_density},
      {"chi-square-two-sample", "draws == draws", "distribution(x.x) == distribution(y.x)", "", "",
       false, &Facts::has_density},
      {"chi-square-fit", "draws == density", "distribution(x.x) == density", "", "{cell_effect}",
       true, &Facts::has_density},
      {"quantile", "median == median", "quantile(x, 0.5) == quantile(y, 0.5)",
       "quantile(shifted, 0.5) == quantile(y, 0.5)", "{shift}", true, &Facts::has_density},
      {"ks", "law == law", "distribution(x) == distribution(y)", "", "{law_effect}", true,
       [](const Facts& f) { return !f.has_density; }},
      {"image", "image == analytic", "mean(picture) == analytic", "bias(picture) == {bias}",
       "{bias}", true, nullptr, classical_replicates},
      {"image", "image == image", "mean(picture) == mean(other_picture)",
       "mean(picture) == {brighter} * mean(other_picture)", "{image_part}%", true, nullptr,
       classical_replicates},
      {"image", "image within x of analytic", "mean(picture) within {bias} of analytic",
       "bias(picture) within {bias} of {bias}", "", true, nullptr, classical_replicates}};
  return drafts;
}

std::vector<Draft> drafts_of(const Facts& facts) {
  const auto written = [&](const std::string& claim) {
    const auto exact = [](double value) { return fmt::format("{:.17g}", value); };
    const double factor = 1 + variance_effect;
    return fmt::format(
        fmt::runtime(claim), fmt::arg("law", facts.law), fmt::arg("mean", exact(facts.mean)),
        fmt::arg("less", exact(facts.mean - facts.shift())),
        fmt::arg("more", exact(facts.mean + facts.shift())),
        fmt::arg("shift", exact(facts.shift())), fmt::arg("variance", exact(facts.variance())),
        fmt::arg("smaller", exact(facts.variance() / factor)), fmt::arg("factor", exact(factor)),
        fmt::arg("inverse", exact(1 / factor)), fmt::arg("slope", 2 - slope_effect),
        fmt::arg("bias", exact(image_bias)), fmt::arg("brighter", exact(1 + image_part)),
        fmt::arg("variance_effect", 100 * variance_effect), fmt::arg("law_effect", law_effect),
        fmt::arg("cell_effect", cell_effect), fmt::arg("slope_effect", slope_effect),
        fmt::arg("image_part", 100 * image_part));
  };
  std::vector<Draft> drafts;
  for (const Draft& draft : all_drafts()) {
    if (draft.suits && !draft.suits(facts)) continue;
    drafts.push_back(draft);
    for (auto text : {&Draft::holds, &Draft::off, &Draft::detect}) {
      drafts.back().*text = written(draft.*text);
    }
  }
  return drafts;
}

using reports::CalibrationCell;
using reports::Rate;
using reports::Verdict;
using reports::VerdictRates;

/// A claim as a suite of its own, if the case has it, and its outcomes over the seeds. Until all
/// runs are done, rates are sums of whole numbers: the order of seeds does not matter.
struct CalibratedClaim {
  std::optional<Suite> suite = {};
  VerdictRates rates = {};
  std::uint64_t mistaken_not_red = 0;  ///< Mistakes in runs without a red gate.
};

/// A method on a question about a law at one alpha. The limits of its rates need the total number
/// of cells.
struct CalibrationCase {
  CalibrationCell cell = {};  ///< The rates come last.
  /// Theta is 0. Missing if another method is the question's default.
  CalibratedClaim holds = {};
  /// Theta is at `detect`, for a proof at the border of the forbidden region. Missing if another
  /// method is the question's default, or no law at that distance is available.
  CalibratedClaim off = {};
  /// The claim on which a verdict against the level is possible, with this method forced and all
  /// observations in one look. Gates are shown but have no effect.
  CalibratedClaim alone = {};
};

constexpr double usual_beta = 0.01;

Suite suite_of(const std::string& claim, const TestKeys& keys) {
  Suite suite{.name = "calibration", .stem = "calibration", .beta = usual_beta};
  suite.tests = {test_of("calibration", claim, keys)};
  return suite;
}

CalibrationCase case_of(const Draft& draft, const Facts& facts,
                        std::optional<std::uint64_t> samples) {
  CalibrationCase made{
      .cell = {.method = draft.method, .question = draft.question, .law = facts.law}};
  made.cell.proof = parse_claim(draft.holds, {}).relation == Relation::within;
  TestKeys keys = draft.keys;
  if (samples) keys["secondaries"] = fmt::format("{}", *samples);
  TestKeys forced = keys;
  forced["test"] = draft.method;
  forced.emplace("secondaries", fmt::format("{}", draft.alone));
  made.alone.suite = suite_of(made.cell.proof ? draft.off : draft.holds, forced);
  if (!draft.is_default) return made;
  if (!draft.detect.empty()) keys["detect"] = draft.detect;
  made.holds.suite = suite_of(draft.holds, keys);
  if (!draft.off.empty()) made.off.suite = suite_of(draft.off, keys);
  return made;
}

/// The cases of one law with their estimators; empty if no question suits the method and the law.
/// Questions point into it, so it cannot move.
struct CalibrationBench {
  std::map<std::string, PreparedEstimator> estimators;
  std::vector<CalibrationCase> cases;

  CalibrationBench(const std::string& law, const CalibrateArguments& arguments) {
    Facts facts = facts_of(law);
    if (facts.has_density) facts.shift_at_law_effect = shift_at_law_effect(facts);
    for (const EstimatorEntry& entry :
         {drawn_from(law, "x"), drawn_from(law, "y"), drawn_from(law, "shifted", facts.shift()),
          drawn_from(law, "moved", facts.shift_at_law_effect),
          drawn_from(law, "scaled", 0, std::sqrt(1 + variance_effect)),
          entry_of("costly", "analytic/costly_law", law),
          entry_of("other_costly", "analytic/costly_law", law), picture_of(law, "picture"),
          picture_of(law, "other_picture")}) {
      estimators.emplace(entry.name, prepare(entry, "."));
    }
    for (const Draft& draft : drafts_of(facts)) {
      const bool wanted =
          arguments.methods.empty() || std::ranges::count(arguments.methods, draft.method);
      if (wanted) cases.push_back(case_of(draft, facts, arguments.samples));
    }
  }
  CalibrationBench(const CalibrationBench&) = delete;
  CalibrationBench& operator=(const CalibrationBench&) = delete;
};

/// The law that a user names: a family's default, or any with its numbers. InputError with the
/// known laws if there is none.
std::string calibration_law(const std::string& named) {
  if (named.ends_with(')')) {
    facts_of(named);
    return named;
  }
  for (const std::string& law : calibration_laws()) {
    if (law.starts_with(named + "(")) return law;
  }
  refuse({},
         "--law: `{}` is no law that is calibrated by default; there is {}, and any law of "
         "`assay describe analytic/law` with its numbers",
         named, fmt::join(calibration_laws(), ", "));
}

// ---- Runs

/// The claims of cases at a level. A proof errs by passing, so its level is beta.
std::vector<CalibratedClaim*> claims_of(std::vector<CalibrationCase>& all) {
  std::vector<CalibratedClaim*> claims;
  for (CalibrationCase& each : all) {
    for (CalibratedClaim* const claim : {&each.holds, &each.off, &each.alone}) {
      if (!claim->suite) continue;
      claim->suite->alpha = each.cell.alpha;
      if (each.cell.proof) claim->suite->beta = each.cell.alpha;
      claims.push_back(claim);
    }
  }
  return claims;
}

/// Errors and refusals count as invalid.
Rate& rate_of(Verdict verdict, VerdictRates& rates) {
  if (verdict == Verdict::pass) return rates.pass;
  if (verdict == Verdict::fail) return rates.fail;
  return verdict == Verdict::inconclusive ? rates.inconclusive : rates.invalid;
}

void tally(const TestOutcome& outcome, CalibratedClaim& claim) {
  const auto any_red = [](const std::vector<Gate>& gates) {
    return std::ranges::any_of(gates, &Gate::is_red);
  };
  const bool red = any_red(outcome.plan.gates) || any_red(outcome.gates);
  const bool proof = is_proof(outcome.question.test->claim.relation);
  const bool mistaken = outcome.verdict == (proof ? Verdict::pass : Verdict::fail);
  VerdictRates& rates = claim.rates;
  ++rates.pass.runs;
  ++rate_of(outcome.verdict, rates).count;
  rates.red.count += red ? 1 : 0;
  claim.mistaken_not_red += mistaken && !red ? 1 : 0;
  rates.observations += static_cast<double>(outcome.secondaries());
  const std::string& method = outcome.plan.method.name;
  auto judged = std::ranges::find(rates.by, method, &reports::MethodRuns::method);
  if (judged == rates.by.end()) judged = rates.by.insert(judged, {method, 0});
  ++judged->runs;
}

/// All claims see the same observations.
void run_once(const CalibrationBench& bench, const std::vector<CalibratedClaim*>& claims,
              std::uint64_t seed, std::mutex& counting) {
  const std::vector<Question> questions = mapped(claims, [&](const CalibratedClaim* claim) {
    return ask(claim->suite->tests[0], bench.estimators, seed);
  });
  const Pilots pilots = pilots_of(questions, seed, *threads(1));
  Pools pools;
  std::vector<TestWork> works = mapped_indices(claims.size(), [&](std::size_t i) {
    TestWork work{.outcome = plan_alone(*claims[i]->suite, questions[i], pilots),
                  .verdict_only = true};
    work.pools = pools.for_question(work.outcome.question, work.outcome.plan, seed, pilots);
    return work;
  });
  const std::vector<TestWork*> open = mapped(works, [](TestWork& work) { return &work; });
  for (const auto& pool : pools.all()) {
    // A calibration shows no histograms.
    for (ChannelPlan& channel : pool->plans()) channel.histogram_high = channel.histogram_low;
  }
  sample_in_looks(open, pools.all(), {.executor = threads(1)}, silence);
  if (interrupted()) return;
  const std::lock_guard lock(counting);
  for (std::size_t i = 0; i < claims.size(); ++i) tally(works[i].outcome, *claims[i]);
}

/// The cases of one law, by alpha. `done` gets the number of finished runs, on the calling thread.
std::vector<CalibrationCase> measure(const CalibrationBench& bench,
                                     const CalibrateArguments& arguments,
                                     const std::function<void(std::uint64_t)>& done) {
  std::vector<CalibrationCase> all;
  for (const double alpha : arguments.alphas) {
    for (const CalibrationCase& each : bench.cases) all.emplace_back(each).cell.alpha = alpha;
  }
  const std::vector<CalibratedClaim*> claims = claims_of(all);
  std::atomic<std::uint64_t> next{0};
  std::mutex mutex;
  std::exception_ptr trouble;
  const auto work = [&](bool tells) {
    try {
      for (std::uint64_t run = next++; run < arguments.runs && !interrupted(); run = next++) {
        run_once(bench, claims, arguments.seed + run, mutex);
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
Rate with_limits(std::uint64_t count, std::uint64_t runs, double error) {
  if (runs == 0) return {};
  const stats::Interval limits =
      stats::clopper_pearson({.successes = count, .trials = runs}, 1 - 2 * error);
  return {.count = count, .runs = runs, .low = limits.low, .high = limits.high};
}

VerdictRates with_limits(VerdictRates rates, double error) {
  const std::uint64_t runs = rates.runs();
  for (Rate* rate : {&rates.pass, &rates.fail, &rates.inconclusive, &rates.invalid, &rates.red}) {
    *rate = with_limits(rate->count, runs, error);
  }
  rates.observations /= static_cast<double>(std::max<std::uint64_t>(runs, 1));
  std::ranges::sort(rates.by, {}, &reports::MethodRuns::method);
  std::ranges::stable_sort(rates.by, std::greater{}, &reports::MethodRuns::runs);
  return rates;
}

/// Groups cells by alpha, then method and question. Alphas, questions and laws keep their order.
void group(std::vector<CalibrationCase>& all, const std::vector<double>& alphas) {
  const auto question = [](const CalibrationCase& each) {
    return each.cell.method + each.cell.question;
  };
  std::map<std::string, std::size_t> questions;
  for (const CalibrationCase& each : all) questions.try_emplace(question(each), questions.size());
  std::ranges::stable_sort(all, {}, [&](const CalibrationCase& each) {
    return std::pair(std::ranges::find(alphas, each.cell.alpha), questions.at(question(each)));
  });
}

/// Refuses repeated levels and laws, which would be measured twice.
template <class T>
void refuse_twice(const char* option, const std::vector<T>& values) {
  for (auto each = values.begin(); each != values.end(); ++each) {
    if (std::find(values.begin(), each, *each) == each) continue;
    refuse({}, "{} {} is given twice", option, *each);
  }
}

}  // namespace

const std::vector<std::string>& calibration_laws() {
  static const std::vector<std::string> laws{
      "normal(0, 1)",    "exponential(1)", "lognormal(0, 0.5)", "lognormal(0, 1)",
      "bernoulli(0.01)", "student_t(5)",   "uniform(0, 1)",     "zero_inflated(0.1)"};
  return laws;
}

reports::Calibration calibration(const CalibrateArguments& arguments, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  reports::Calibration result{
      .tool = this_tool(),
      .environment = this_environment(arguments.threads),
      .seed = arguments.seed,
      .runs = arguments.runs,
      .started = utc_now(),
      .detect = fmt::format("{:g} standard deviations of means and medians; {:g} % of "
                            "variances, efficiencies and costs; a distance {:g} of laws; w "
                            "{:g} of cells; {:g} of slopes; of images a bias of {:g}, or "
                            "{:g} % of one another",
                            mean_effect, 100 * variance_effect, law_effect, cell_effect,
                            slope_effect, image_bias, 100 * image_part)};
  std::vector<std::string> laws = mapped(arguments.laws, calibration_law);
  std::vector<std::string> without_blanks = laws;
  for (std::string& law : without_blanks) std::erase(law, ' ');
  refuse_twice("--law", without_blanks);
  refuse_twice("--alpha", arguments.alphas);
  if (laws.empty()) laws = calibration_laws();
  CalibrateArguments options = arguments;
  if (options.alphas.empty()) options.alphas = {0.05, 0.01, 0.001};
  std::set<std::string> known;
  for (const Draft& draft : all_drafts()) known.insert(draft.method);
  for (const std::string& method : arguments.methods) {
    choice(Value::scalar(method), "a method to calibrate", {known.begin(), known.end()});
  }
  refuse_twice("METHOD", arguments.methods);
  std::vector<CalibrationCase> all;
  progress.begin({"calibration", laws.size() * arguments.runs});
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const CalibrationBench bench(laws[i], arguments);
    if (bench.cases.empty()) continue;
    std::ranges::move(
        measure(bench, options,
                [&](std::uint64_t done) { progress.advance(i * arguments.runs + done); }),
        std::back_inserter(all));
  }
  progress.end();
  if (all.empty()) {
    refuse({}, "no claim suits `{}` on these laws", fmt::join(arguments.methods, "`, `"));
  }
  group(all, options.alphas);
  const double error = result.error / static_cast<double>(all.size());
  result.cells = mapped(all, [&](const CalibrationCase& each) {
    CalibrationCell cell = each.cell;
    cell.holds = with_limits(each.holds.rates, error);
    cell.off = with_limits(each.off.rates, error);
    cell.alone = with_limits(each.alone.rates, error);
    cell.alone_not_red = with_limits(each.alone.mistaken_not_red, each.alone.rates.runs(), error);
    return cell;
  });
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
