
#include "harness/theta/ask.h"
#include "harness/theta/methods.h"
#include "tests/harness/prelude.h"
#include "tests/harness/questions.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

stats::Moments moments_of(const std::vector<double>& values) {
  stats::Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

/// Moments of n values of exactly this mean and variance: half on each side.
stats::Moments two_values(double mean, double variance, std::uint64_t n) {
  const double step = std::sqrt(variance * static_cast<double>(n - 1) / static_cast<double>(n));
  stats::Moments moments;
  for (std::uint64_t i = 0; i < n; ++i) moments.add(mean + (i % 2 == 0 ? step : -step));
  return moments;
}

constexpr const char* suite = R"(suite: methods
estimators:
  a: {plugin: analytic/normal, mean: 2}
  b: {plugin: analytic/normal, mean: -3}
  ratio: {plugin: analytic/ratio, primaries: 16}
  hemisphere: {plugin: luminaire/hemisphere, scene: triangle}
tests:
  - {name: mean, claim: mean(a) == 2}
  - {name: absolute, claim: mean(a) == 2, detect: 0.1}
  - {name: negative, claim: mean(b) == -3}
  - {name: zero, claim: mean(a) == 0}
  - {name: means, claim: mean(a) == -0.5 * mean(b)}
  - {name: variance, claim: variance(a) == 4}
  - {name: variances, claim: variance(a) == 2 * variance(b)}
  - {name: of a ratio, claim: variance(ratio) == variance(a)}
  - {name: tost, claim: mean(a) within 1% of 2}
  - {name: law, claim: 'distribution(a) == normal(2, 1)'}
  - {name: fit, claim: distribution(hemisphere.direction) == density}
)";

/// A side's data, which cannot be copied.
struct Side {
  std::uint64_t primaries = 1;
  stats::Moments moments = {};
  std::span<const double> values = {};
};

Evidence evidence(const std::string& name, const std::vector<Side>& sides,
                  const std::string& method = "") {
  std::vector<ChannelData> data(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    data[i].primaries = sides[i].primaries;
    data[i].moments = sides[i].moments;
    data[i].values = sides[i].values;
  }
  const auto asked = ask_text(suite);
  const Question& question = asked->question(name);
  return (method.empty() ? methods_for(question).front() : find_method(question, method))
      .evidence({question, 0, data});
}

TEST(Method, MeasuresInTheEstimatorsUnitWhereMarginsAreAbsolute) {
  const std::vector<Side> data{{.moments = moments_of({1, 2, 3, 4})}};
  EXPECT_DOUBLE_EQ(evidence("absolute", data).estimate, 0.5);
  EXPECT_DOUBLE_EQ(evidence("zero", data).estimate, 2.5) << "nothing to be relative to";
}

TEST(Method, RelativeDifferenceFromANegativeReferenceKeepsItsSign) {
  const Evidence above = evidence("negative", {{.moments = two_values(-2.7, 1, 100)}});
  EXPECT_NEAR(above.estimate, 0.1, 1e-12) << "-2.7 is above -3";
  EXPECT_LT(above.at(0).log_p_upper, above.at(0).log_p_lower);
}

TEST(Method, WelchIsAContrastWhateverTheFactorsSign) {
  const Evidence means =
      evidence("means", {{.moments = two_values(1.8, 2, 50)}, {.moments = two_values(-3, 1, 50)}});
  // -0.5 * -3 = 1.5; 1.8 is 20 % more.
  EXPECT_NEAR(means.estimate, 0.2, 1e-12);
  EXPECT_NEAR(means.at(0).statistic, (1.8 - 1.5) / std::sqrt(2.0 / 50 + 0.25 * 1.0 / 50), 1e-9);
  EXPECT_NEAR(means.at(0.2).statistic, 0, 1e-9);
  const stats::Interval interval = means.interval(0.95);
  EXPECT_LT(interval.low, 0.2);
  EXPECT_GT(interval.high, 0.2);
}

TEST(Method, VarianceIsThatOfOnePrimary) {
  // A secondary of 10 primaries has variance 0.4, a primary 4.
  const Evidence one =
      evidence("variance", {{.primaries = 10, .moments = two_values(2, 0.4, 100)}});
  EXPECT_NEAR(one.estimate, 0, 1e-12);
  const Evidence two = evidence("variances", {{.primaries = 10, .moments = two_values(2, 0.4, 100)},
                                              {.primaries = 4, .moments = two_values(0, 0.5, 80)}});
  EXPECT_NEAR(two.estimate, 0, 1e-12) << "4 against 2 * 2";
}

TEST(Method, VarianceOfARatioIsTheSecondarys) {
  const Evidence two =
      evidence("of a ratio", {{.primaries = 16, .moments = two_values(6, 0.5, 100)},
                              {.primaries = 4, .moments = two_values(0, 0.125, 80)}});
  EXPECT_NEAR(two.estimate, 0, 1e-12) << "0.5 against 4 * 0.125";
}

TEST(Method, InfluenceValuesAndChiSquareAgreeOnTheEstimate) {
  const std::vector<Side> data{{.moments = two_values(0, 5, 1000)}};
  for (const char* method : {"chi-square", "influence-t"}) {
    const Evidence variance = evidence("variance", data, method);
    EXPECT_NEAR(variance.estimate, std::log(5.0 / 4), 1e-12) << method;
    const stats::Interval interval = variance.interval(0.99);
    EXPECT_LT(interval.low, std::log(5.0 / 4)) << method;
    EXPECT_GT(interval.high, std::log(5.0 / 4)) << method;
  }
}

/// p-value and interval are two views of one test: at an end of the interval the nearer tail has
/// half of what the confidence leaves.
TEST(Method, IntervalsEndWhereTheTestBeginsToReject) {
  tests::Philox random(902);
  stats::Moments x;
  stats::Moments y;
  for (int i = 0; i < 60; ++i) x.add(2 + random.normal());
  for (int i = 0; i < 60; ++i) y.add(-3 + 0.5 * random.normal());
  const auto check = [&](const Evidence& tested, const std::string& name) {
    const stats::Interval interval = tested.interval(0.95);
    EXPECT_NEAR(std::exp(tested.at(interval.low).log_p_upper), 0.025, 1e-6) << name;
    EXPECT_NEAR(std::exp(tested.at(interval.high).log_p_lower), 0.025, 1e-6) << name;
  };
  for (const char* name : {"mean", "absolute", "negative", "zero"}) {
    check(evidence(name, {{.moments = x}}), name);
  }
  check(evidence("means", {{.moments = x}, {.moments = y}}), "means");
  check(evidence("variance", {{.moments = x}}), "chi-square");
  check(evidence("variances", {{.moments = x}, {.moments = y}}), "F");
  check(evidence("variance", {{.moments = x}}, "influence-t"), "influence-t");
  check(evidence("variances", {{.moments = x}, {.moments = y}}, "influence-t"), "of two");
}

TEST(Method, NullHypothesisReadsAsAFormula) {
  const auto asked = ask_text(suite);
  const Question& means = asked->question("means");
  EXPECT_EQ(null_hypothesis(means, 0), "mean(a) = -0.5 * mean(b)");
  const Question& variance = asked->question("variance");
  EXPECT_EQ(null_hypothesis(variance, 0), "variance(a) = 4");
}

TEST(Method, MarginOnARatioIsItsLogarithm) {
  const auto asked = ask_text(suite);
  const Margin tenth{.value = 0.1, .relative = true};
  EXPECT_NEAR(margin_on_theta(asked->question("variances"), 0, tenth), std::log(1.1), 1e-15);
  EXPECT_NEAR(margin_on_theta(asked->question("variance"), 0, {.value = 0.4}), std::log(1.1),
              1e-15);
  EXPECT_DOUBLE_EQ(margin_on_theta(asked->question("mean"), 0, tenth), 0.1);
}

}  // namespace
}  // namespace assay::harness
