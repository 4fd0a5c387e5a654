#include "harness/calibration/calibration_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/language/laws.h"
#include "harness/plan/sizes.h"

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
  const PreparedEstimator x = prepare(drawn_from(law, "x"), ".");
  const Channel channel = x.setup->channels()[0];
  if (!channel.mean || !channel.variance) {
    throw InputError({}, fmt::format("`{}` has no variance: nothing is promised on it", law));
  }
  return {.law = law,
          .mean = *channel.mean,
          .deviation = std::sqrt(*channel.variance),
          .low = channel.low,
          .high = channel.high,
          .has_density = !x.setup->samplers().empty()};
}

/// The kinds of `detect`.
enum class Effect { none, shift, ratio, law, cells, slope, bias, part };

std::optional<Margin> margin_of(Effect effect, const Facts& facts) {
  if (effect == Effect::none) return std::nullopt;
  const double values[] = {facts.shift(), variance_effect, law_effect, cell_effect,
                           slope_effect,  image_bias,      image_part};
  return Margin{.value = values[static_cast<int>(effect) - 1],
                .relative = effect == Effect::ratio || effect == Effect::part};
}

bool any_law(const Facts&) { return true; }
bool has_density(const Facts& facts) { return facts.has_density; }

/// A case as text, with numbers of the law by their names.
struct Draft {
  std::string method;
  std::string question;
  std::string holds;
  std::string off = "";
  Effect detect = Effect::none;
  bool is_default = true;
  bool (*suits)(const Facts&) = any_law;
  CostKind cost = CostKind::samples;
  std::uint64_t alone = classical_samples;  ///< Observations of a method alone.
};

const std::vector<Draft>& all_drafts() {
  static const std::vector<Draft> drafts{
      {"t", "mean == number", "mean(x) == {mean}", "mean(x) == {less}", Effect::shift},
      {"t", "mean <= number", "mean(x) <= {mean}", "mean(x) <= {less}", Effect::shift},
      {"t", "mean >= number", "mean(x) >= {mean}", "mean(x) >= {more}", Effect::shift},
      {"welch", "mean == mean", "mean(x) == mean(y)", "mean(shifted) == mean(y)", Effect::shift},
      {"tost", "mean within x of number", "mean(x) within {shift} of {mean}",
       "mean(x) within {shift} of {less}"},
      {"skewness-corrected-t", "mean == number", "mean(x) == {mean}", "", Effect::none, false},
      {"binomial", "mean == number", "mean(x) == {mean}", "", Effect::none, false,
       [](const Facts& f) { return f.two_valued(); }},
      {"betting", "mean == number", "mean(x) == {mean}", "", Effect::none, false,
       [](const Facts& f) { return f.bounded(); }},
      {"betting", "mean <= number", "mean(x) <= {mean}", "", Effect::none, false,
       [](const Facts& f) { return std::isfinite(f.low) && !f.bounded(); }},
      {"chi-square", "variance == number", "variance(x) == {variance}", "variance(x) == {smaller}",
       Effect::ratio},
      {"chi-square", "variance <= number", "variance(x) <= {variance}", "variance(x) <= {smaller}",
       Effect::ratio},
      {"F", "variance == variance", "variance(x) == variance(y)",
       "variance(x) == {factor} * variance(y)", Effect::ratio},
      {"influence-t", "variance == number", "variance(x) == {variance}", "", Effect::none, false},
      {"influence-t", "variance == variance", "variance(x) == variance(y)", "", Effect::none,
       false},
      {"influence-t", "total variance == number", "total_variance(x) == {variance}",
       "total_variance(x) == {smaller}", Effect::ratio},
      {"influence-t", "efficiency == efficiency", "efficiency(x) == efficiency(y)",
       "efficiency(y) == efficiency(scaled)", Effect::ratio},
      {"influence-t", "efficiencies at random costs",
       "efficiency(costly) == efficiency(other_costly)", "", Effect::ratio, true, any_law,
       CostKind::rays},
      {"influence-t", "cost == cost", "cost(costly) == cost(other_costly)",
       "cost(costly) == {factor} * cost(other_costly)", Effect::ratio, true, any_law,
       CostKind::rays},
      {"influence-t", "cost <= cost", "cost(costly) <= cost(other_costly)",
       "cost(costly) <= {inverse} * cost(other_costly)", Effect::ratio, true, any_law,
       CostKind::rays},
      {"slope", "slope of variance", "slope(variance(x)) == 2", "slope(variance(x)) == {slope}",
       Effect::slope},
      {"ks", "law == law given", "distribution(x) == {law}", "distribution(moved) == {law}",
       Effect::law, true, has_density},
      {"ks", "law == law", "distribution(x) == distribution(y)",
       "distribution(moved) == distribution(y)", Effect::law, true, has_density},
      {"chi-square-two-sample", "draws == draws", "distribution(x.x) == distribution(y.x)", "",
       Effect::none, false, has_density},
      {"chi-square-fit", "draws == density", "distribution(x.x) == density", "", Effect::cells,
       true, has_density},
      {"quantile", "median == median", "quantile(x, 0.5) == quantile(y, 0.5)",
       "quantile(shifted, 0.5) == quantile(y, 0.5)", Effect::shift, true, has_density},
      {"ks", "law == law", "distribution(x) == distribution(y)", "", Effect::law, true,
       [](const Facts& f) { return !f.has_density; }},
      {"image", "image == analytic", "mean(picture) == analytic", "bias(picture) == {bias}",
       Effect::bias, true, any_law, CostKind::samples, classical_replicates},
      {"image", "image == image", "mean(picture) == mean(other_picture)",
       "mean(picture) == {brighter} * mean(other_picture)", Effect::part, true, any_law,
       CostKind::samples, classical_replicates},
      {"image", "image within x of analytic", "mean(picture) within {bias} of analytic",
       "bias(picture) within {bias} of {bias}", Effect::none, true, any_law, CostKind::samples,
       classical_replicates}};
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
        fmt::arg("bias", exact(image_bias)), fmt::arg("brighter", exact(1 + image_part)));
  };
  std::vector<Draft> drafts;
  for (const Draft& draft : all_drafts()) {
    if (!draft.suits(facts)) continue;
    drafts.push_back(draft);
    drafts.back().holds = written(draft.holds);
    drafts.back().off = written(draft.off);
  }
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

CalibrationCase case_of(const Draft& draft, const Facts& facts, const CalibrationScope& scope) {
  CalibrationCase made{.method = draft.method, .question = draft.question};
  made.proof = parse_claim(draft.holds, {}).relation == Relation::within;
  made.alone = test_of(made.proof ? draft.off : draft.holds, draft);
  made.alone->method = draft.method;
  made.alone->secondaries = scope.samples.value_or(draft.alone);
  if (!draft.is_default) return made;
  const auto planned = [&](const std::string& claim) {
    TestEntry test = test_of(claim, draft);
    test.secondaries = scope.samples;
    test.detect = margin_of(draft.detect, facts);
    return test;
  };
  made.holds = planned(draft.holds);
  if (!draft.off.empty()) made.off = planned(draft.off);
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
       {drawn_from(law, "x"), drawn_from(law, "y"), drawn_from(law, "shifted", facts.shift()),
        drawn_from(law, "moved", facts.shift_at_law_effect),
        drawn_from(law, "scaled", 0, std::sqrt(1 + variance_effect)),
        entry_of("costly", "analytic/costly_law", law),
        entry_of("other_costly", "analytic/costly_law", law), picture_of(law, "picture"),
        picture_of(law, "other_picture")}) {
    estimators.emplace(entry.name, prepare(entry, "."));
  }
  for (const Draft& draft : drafts_of(facts)) {
    const bool wanted = scope.methods.empty() || std::ranges::count(scope.methods, draft.method);
    if (wanted) cases.push_back(case_of(draft, facts, scope));
  }
}

}  // namespace assay::harness
