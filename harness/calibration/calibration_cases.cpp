#include "harness/calibration/calibration_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/language/laws.h"
#include "harness/plan/image_plan.h"

namespace assay::harness {
namespace {

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

EstimatorEntry entry_of(const std::string& name, const std::string& law, double shift,
                        double scale) {
  return {.name = name,
          .plugin = "analytic/law",
          .parameters = Value::map({{"law", Value::scalar(law)},
                                    {"shift", Value::scalar(fmt::format("{:.17g}", shift))},
                                    {"scale", Value::scalar(fmt::format("{:.17g}", scale))}}),
          .primaries = 1};
}

EstimatorEntry costly(const std::string& name, const std::string& law) {
  return {.name = name,
          .plugin = "analytic/costly_law",
          .parameters = Value::map({{"law", Value::scalar(law)}}),
          .primaries = 1};
}

/// 64 pixels with means from 1 to 10, each with this law's noise.
EstimatorEntry picture_of(const std::string& name, const std::string& law) {
  return {.name = name,
          .plugin = "analytic/ramp",
          .parameters = Value::map({{"law", Value::scalar(law)},
                                    {"width", Value::scalar("8")},
                                    {"height", Value::scalar("8")}}),
          .primaries = 4};
}

/// sup over x of P(x - shift < X <= x).
double distance_at(const std::function<double(double)>& cdf, const Facts& facts, double shift) {
  constexpr int steps = 2000;
  double largest = 0;
  for (int i = 0; i <= steps; ++i) {
    const double x = facts.mean + facts.deviation * (16.0 * i / steps - 8);
    largest = std::max(largest, cdf(x) - cdf(x - shift));
  }
  return largest;
}

double shift_at_law_effect(const Facts& facts) {
  const Source place{};
  const Claim claim = parse_claim("distribution(x) == " + facts.law, place.where);
  const std::function<double(double)> cdf = law_cdf(std::get<Law>(claim.right));
  double low = 0;
  double high = facts.deviation;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (distance_at(cdf, facts, middle) < law_effect ? low : high) = middle;
  }
  return high;
}

Facts facts_of(const std::string& law) {
  const PreparedEstimator x = prepare(entry_of("x", law, 0, 1), ".");
  const Channel channel = x.setup->channels()[0];
  if (!channel.mean || !channel.variance) {
    throw InputError({}, fmt::format("`{}` has no variance: nothing is promised on it", law));
  }
  Facts facts{.law = law,
              .mean = *channel.mean,
              .deviation = std::sqrt(*channel.variance),
              .low = channel.low,
              .high = channel.high,
              .has_density = !x.setup->samplers().empty()};
  return facts;
}

/// A case as text, before its tests are made.
struct Draft {
  std::string method;
  std::string question;
  std::string holds;
  std::string off = "";
  std::optional<Margin> detect = {};
  bool is_default = true;
  CostKind cost = CostKind::samples;
  std::uint64_t alone = classical_samples;  ///< Observations of a method alone.
};

void means(const Facts& f, std::vector<Draft>& drafts) {
  const Margin detect{.value = f.shift()};
  const auto against = [&](const char* relation, double reference) {
    return fmt::format("mean(x) {} {:.17g}", relation, reference);
  };
  drafts.push_back(
      {"t", "mean == number", against("==", f.mean), against("==", f.mean - f.shift()), detect});
  drafts.push_back(
      {"t", "mean <= number", against("<=", f.mean), against("<=", f.mean - f.shift()), detect});
  drafts.push_back(
      {"t", "mean >= number", against(">=", f.mean), against(">=", f.mean + f.shift()), detect});
  drafts.push_back(
      {"welch", "mean == mean", "mean(x) == mean(y)", "mean(shifted) == mean(y)", detect});
  const std::string within = fmt::format("within {:.17g} of", f.shift());
  drafts.push_back({"tost", "mean within x of number", against(within.c_str(), f.mean),
                    against(within.c_str(), f.mean - f.shift())});
  std::vector<const char*> others{"skewness-corrected-t"};
  if (f.two_valued()) others.push_back("binomial");
  if (f.bounded()) others.push_back("betting");
  for (const char* method : others) {
    drafts.push_back({.method = method,
                      .question = "mean == number",
                      .holds = against("==", f.mean),
                      .is_default = false});
  }
  if (f.bounded() || !std::isfinite(f.low)) return;
  drafts.push_back({.method = "betting",
                    .question = "mean <= number",
                    .holds = against("<=", f.mean),
                    .is_default = false});
}

void variances(const Facts& f, std::vector<Draft>& drafts) {
  const Margin detect{.value = variance_effect, .relative = true};
  const auto against = [&](const char* relation, double factor) {
    return fmt::format("variance(x) {} {:.17g}", relation, f.variance() / factor);
  };
  const double factor = 1 + variance_effect;
  drafts.push_back(
      {"chi-square", "variance == number", against("==", 1), against("==", factor), detect});
  drafts.push_back(
      {"chi-square", "variance <= number", against("<=", 1), against("<=", factor), detect});
  drafts.push_back({"F", "variance == variance", "variance(x) == variance(y)",
                    fmt::format("variance(x) == {:.17g} * variance(y)", factor), detect});
  drafts.push_back({.method = "influence-t",
                    .question = "variance == number",
                    .holds = against("==", 1),
                    .is_default = false});
  drafts.push_back({.method = "influence-t",
                    .question = "variance == variance",
                    .holds = "variance(x) == variance(y)",
                    .is_default = false});
  drafts.push_back({"influence-t", "total variance == number", "total_" + against("==", 1),
                    "total_" + against("==", factor), detect});
  drafts.push_back({"influence-t", "efficiency == efficiency", "efficiency(x) == efficiency(y)",
                    "efficiency(y) == efficiency(scaled)", detect});
  const auto costly = [&](const char* method, const char* question, const std::string& holds,
                          const std::string& off) {
    drafts.push_back({.method = method,
                      .question = question,
                      .holds = holds,
                      .off = off,
                      .detect = detect,
                      .cost = CostKind::rays});
  };
  costly("influence-t", "efficiencies at random costs",
         "efficiency(costly) == efficiency(other_costly)", "");
  costly("influence-t", "cost == cost", "cost(costly) == cost(other_costly)",
         fmt::format("cost(costly) == {:.17g} * cost(other_costly)", factor));
  costly("influence-t", "cost <= cost", "cost(costly) <= cost(other_costly)",
         fmt::format("cost(costly) <= {:.17g} * cost(other_costly)", 1 / factor));
  drafts.push_back({"slope", "slope of variance", "slope(variance(x)) == 2",
                    fmt::format("slope(variance(x)) == {}", 2 - slope_effect),
                    Margin{.value = slope_effect}});
}

void laws_themselves(const Facts& f, std::vector<Draft>& drafts) {
  const Margin detect{.value = law_effect};
  if (f.has_density) {
    drafts.push_back({"ks", "law == law given", "distribution(x) == " + f.law,
                      "distribution(moved) == " + f.law, detect});
    drafts.push_back({"ks", "law == law", "distribution(x) == distribution(y)",
                      "distribution(moved) == distribution(y)", detect});
    drafts.push_back({.method = "chi-square-two-sample",
                      .question = "draws == draws",
                      .holds = "distribution(x.x) == distribution(y.x)",
                      .is_default = false});
    drafts.push_back({"chi-square-fit", "draws == density", "distribution(x.x) == density", "",
                      Margin{.value = cell_effect}});
    drafts.push_back({"quantile", "median == median", "quantile(x, 0.5) == quantile(y, 0.5)",
                      "quantile(shifted, 0.5) == quantile(y, 0.5)", Margin{.value = f.shift()}});
    return;
  }
  drafts.push_back({"ks", "law == law", "distribution(x) == distribution(y)", "", detect});
}

std::vector<Draft> images() {
  std::vector<Draft> drafts;
  const Margin bias{.value = image_bias};
  drafts.push_back({"image", "image == analytic", "mean(picture) == analytic",
                    fmt::format("bias(picture) == {:.17g}", image_bias), bias});
  const Margin part{.value = image_part, .relative = true};
  drafts.push_back({"image", "image == image", "mean(picture) == mean(other_picture)",
                    fmt::format("mean(picture) == {:.17g} * mean(other_picture)", 1 + image_part),
                    part});
  const std::string within = fmt::format("mean(picture) within {:.17g} of ", image_bias);
  drafts.push_back({"image", "image within x of analytic", within + "analytic",
                    fmt::format("bias(picture) within {0:.17g} of {0:.17g}", image_bias)});
  for (Draft& draft : drafts) draft.alone = classical_replicates;
  return drafts;
}

std::vector<Draft> drafts_of(const Facts& facts) {
  std::vector<Draft> drafts;
  means(facts, drafts);
  variances(facts, drafts);
  laws_themselves(facts, drafts);
  for (Draft& draft : images()) drafts.push_back(std::move(draft));
  return drafts;
}

TestEntry test_of(const std::string& claim, const Draft& draft) {
  TestEntry test{.name = claim, .id = "calibration/" + claim, .claim = parse_claim(claim, {})};
  test.cost = draft.cost;
  if (test.claim.left.slope) {
    test.over = Sweep{
        "scale", {Value::scalar("1"), Value::scalar("2"), Value::scalar("4"), Value::scalar("8")}};
  }
  return test;
}

TestEntry planned(const std::string& claim, const Draft& draft, const CalibrationScope& scope) {
  TestEntry test = test_of(claim, draft);
  test.secondaries = scope.samples;
  test.detect = draft.detect;
  return test;
}

CalibrationCase case_of(const Draft& draft, const CalibrationScope& scope) {
  CalibrationCase made{.method = draft.method, .question = draft.question};
  made.proof = parse_claim(draft.holds, {}).relation == Relation::within;
  made.alone = test_of(made.proof ? draft.off : draft.holds, draft);
  made.alone->method = draft.method;
  made.alone->secondaries = scope.samples.value_or(draft.alone);
  if (!draft.is_default) return made;
  made.holds = planned(draft.holds, draft, scope);
  if (!draft.off.empty()) made.off = planned(draft.off, draft, scope);
  return made;
}

}  // namespace

std::string calibration_effects() {
  return fmt::format(
      "{:g} standard deviations of means and medians; {:g} % of variances, efficiencies and costs; "
      "a distance {:g} of laws; w {:g} of cells; {:g} of slopes; of images a bias of {:g}, or {:g} "
      "% of one another",
      mean_effect, 100 * variance_effect, law_effect, cell_effect, slope_effect, image_bias,
      100 * image_part);
}

const std::vector<std::string>& calibration_laws() {
  static const std::vector<std::string> laws{
      "normal(0, 1)",    "exponential(1)", "lognormal(0, 0.5)", "lognormal(0, 1)",
      "bernoulli(0.01)", "student_t(5)",   "uniform(0, 1)",     "zero_inflated(0.1)"};
  return laws;
}

std::string calibration_law(const std::string& named) {
  if (named.find('(') != std::string::npos) {
    facts_of(named);
    return named;
  }
  for (const std::string& law : calibration_laws()) {
    if (law.starts_with(named + "(")) return law;
  }
  throw InputError({}, fmt::format("--law: there is no law `{}`; there is {}, and any of these "
                                   "families with other numbers",
                                   named, fmt::join(calibration_laws(), ", ")));
}

void require_calibrated(const std::string& method) {
  std::set<std::string> known;
  for (const std::string& law : calibration_laws()) {
    for (const Draft& draft : drafts_of(facts_of(law))) known.insert(draft.method);
  }
  if (known.contains(method)) return;
  const std::string near = nearest(method, {known.begin(), known.end()});
  throw InputError({}, fmt::format("no method `{}` can be calibrated{}; there is {}", method,
                                   near.empty() ? "" : fmt::format(" (did you mean `{}`?)", near),
                                   fmt::join(known, ", ")));
}

CalibrationBench::CalibrationBench(const CalibrationScope& scope) : law(scope.law) {
  Facts facts = facts_of(scope.law);
  if (facts.has_density) facts.shift_at_law_effect = shift_at_law_effect(facts);
  for (const EstimatorEntry& entry :
       {entry_of("x", law, 0, 1), entry_of("y", law, 0, 1),
        entry_of("shifted", law, facts.shift(), 1),
        entry_of("moved", law, facts.shift_at_law_effect, 1),
        entry_of("scaled", law, 0, std::sqrt(1 + variance_effect)), costly("costly", law),
        costly("other_costly", law), picture_of("picture", law),
        picture_of("other_picture", law)}) {
    estimators.emplace(entry.name, prepare(entry, "."));
  }
  for (const Draft& draft : drafts_of(facts)) {
    const bool wanted = scope.methods.empty() || std::ranges::count(scope.methods, draft.method);
    if (wanted) cases.push_back(case_of(draft, scope));
  }
}

}  // namespace assay::harness
