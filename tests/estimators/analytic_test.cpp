#include "tests/estimators/prelude.h"
// The teaching estimators: what they declare against sums worked out here and against sampling.

namespace assay {
namespace {

const double e3 = std::exp(3.0);
const double integral = (e3 - 1) / 3;

double f(double x) { return std::exp(3 * x); }
double q(double x) { return 5 * std::pow(1 + x, 4) / 31; }

// Simpson's rule on [0, 1], error below 1e-10 for what stands here.
template <class F>
double simpson(const F& g) {
  constexpr int n = 2000;
  double sum = g(0.0) + g(1.0);
  for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4 : 2) * g(i / double{n});
  return sum / (3 * n);
}

TEST(Analytic, VariancesAreThoseOfQuadrature) {
  const auto expect = [](const char* plugin, const auto& of_square) {
    const double variance = simpson(of_square) - integral * integral;
    EXPECT_NEAR(*channel(plugin).variance, variance, 1e-8) << plugin;
  };
  expect("analytic/exponential_uniform", [](double x) { return f(x) * f(x); });
  expect("analytic/exponential_importance", [](double x) { return f(x) * f(x) / q(x); });
  expect("analytic/antithetic", [](double x) { return std::pow((f(x) + f(1 - x)) / 2, 2); });
  expect("analytic/control_variate",
         [](double x) { return std::pow(f(x) - 2.3 * (1 + 3 * x + 4.5 * x * x - 4), 2); });
  const double plain = *channel("analytic/exponential_uniform").variance;
  EXPECT_NEAR(*channel("analytic/control_variate", "{coefficient: 0}").variance, plain, 1e-12);
  EXPECT_NEAR(*channel("analytic/stratified", "{strata: 1}").variance, plain, 1e-12);
}

TEST(Analytic, StratifiedVarianceIsTheMeanOfTheStrata) {
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    const auto in_stratum = [j](double x) { return f((j + x) / 4); };
    const double mean = simpson(in_stratum);
    sum += simpson([&](double x) { return std::pow(in_stratum(x) - mean, 2); });
  }
  EXPECT_NEAR(*channel("analytic/stratified", "{strata: 4}").variance, sum / 16, 1e-9);
}

TEST(Analytic, MeansAreClosedForms) {
  for (const char* plugin : {"exponential_uniform", "exponential_importance", "control_variate",
                             "stratified", "antithetic", "ratio", "zero_variance"}) {
    EXPECT_DOUBLE_EQ(*channel(std::string("analytic/") + plugin).mean, integral);
  }
  EXPECT_DOUBLE_EQ(*channel("analytic/heavy_tail", "{index: 3}").mean, 1.5);
  EXPECT_DOUBLE_EQ(*channel("analytic/heavy_tail", "{index: 3}").variance, 0.75);
  EXPECT_FALSE(channel("analytic/heavy_tail", "{index: 2}").variance.has_value());
  EXPECT_FALSE(channel("analytic/heavy_tail", "{index: 2.6}").variance.has_value());
  EXPECT_DOUBLE_EQ(*channel("analytic/rare_spike").mean, 0.51);
  EXPECT_DOUBLE_EQ(*channel("analytic/two_level").mean, 17.0 / 6);
}

// The mean of u^-s over all 2^52 values of u misses a share of the integral 1 / (1 - s). By zeta(s,
// 1/2) = (2^s - 1) zeta(s) the share is -(1 - s) zeta(s, 1/2) 2^(-52 (1 - s)). It is below 1e-4 for
// the declared values.
TEST(Analytic, HeavyTailsDeclareOnlyWhatTheirStreamCanReach) {
  const auto missed = [](double s) {
    return -(1 - s) * std::exp2(-52 * (1 - s)) * (std::exp2(s) - 1) * std::riemann_zeta(s);
  };
  EXPECT_TRUE(channel("analytic/heavy_tail", "{index: 1.34}").mean.has_value());
  EXPECT_LT(missed(1 / 1.34), 1e-4);
  EXPECT_TRUE(channel("analytic/heavy_tail", "{index: 2.67}").variance.has_value());
  EXPECT_LT(missed(2 / 2.67), 1e-4);
}

TEST(Analytic, ZeroVarianceIsConstantToRounding) {
  const auto plugin = prepare("analytic/zero_variance");
  for (const std::uint64_t primaries : {1U, 100U}) {
    EXPECT_THAT(observe(plugin, 10000, primaries)[0].values,
                Each(AllOf(Ge(plugin.channel().low), Le(plugin.channel().high))));
  }
  EXPECT_NE(observe(plugin, 100)[0].variance(), 0) << "rounding shows, which is the point";
}

// n bias -> I Var g - Cov(f, g) = -0.50012; the next order is some 1 / n of it. False alarm 1e-6.
TEST(Analytic, RatioBiasFallsLikeOneOverPrimaries) {
  const double of_g = simpson([](double x) { return q(x) * q(x); }) - 1;
  const double covariance = simpson([](double x) { return f(x) * q(x); }) - integral;
  const double limit = integral * of_g - covariance;
  EXPECT_NEAR(limit, -0.50012, 5e-6);
  const auto plugin = prepare("analytic/ratio");
  EXPECT_EQ(plugin.information.bias, BiasClass::inverse_primaries);
  EXPECT_FALSE(plugin.information.averages);
  const double n = 16;
  const Sample sample = observe(plugin, 400000, 16)[0];
  EXPECT_NEAR(n * (sample.mean() - integral), limit, 0.05 + five * n * sample.mean_error());
  EXPECT_THAT(sample.values, Each(AllOf(Ge(plugin.channel().low), Le(plugin.channel().high))));
}

TEST(Analytic, ARareSpikeDeclaresItsRangeOrNot) {
  const Channel known = channel("analytic/rare_spike", "{height: 2, noise: 0.25}");
  EXPECT_EQ(known.low, 0.25);
  EXPECT_EQ(known.high, 2.75);
  EXPECT_EQ(channel("analytic/rare_spike", "{declared: false}").high,
            std::numeric_limits<double>::infinity());
}

TEST(Analytic, ARareSpikeStaysUnseenInAShortRun) {
  EXPECT_THAT(observe(prepare("analytic/rare_spike", "{probability: 0}"), 1000)[0].values,
              Each(0.5));
}

TEST(Analytic, ACostlyLawCostsWhatItsValuesSay) {
  const auto plugin = prepare("analytic/costly_law", "{law: student_t(5), rays: 10}");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto [values, cost] = observe_one(plugin, 1, i);
    const auto rays = static_cast<std::uint64_t>(10 * std::abs(values[0]));
    EXPECT_EQ(cost, (Cost{.shadow_rays = 1 + rays, .samples = 1}));
  }
}

// False alarm 1e-6.
TEST(Analytic, ImportanceSamplerFollowsItsDensity) {
  const auto plugin = prepare("analytic/exponential_importance");
  const auto sampler = plugin.sampler("x");
  std::vector<double> counts(50);
  constexpr int draws = 100000;
  for (std::uint64_t i = 0; i < draws; ++i) {
    Stream random(plugin.key, i);
    const SamplerDraw draw = sampler->sample(random);
    EXPECT_DOUBLE_EQ(draw.weight * draw.density, f(draw.point[0]));
    counts[static_cast<std::size_t>(std::min(49.0, 50 * draw.point[0]))] += 1;
  }
  Pearson pearson;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto cumulative = [](double x) { return (std::pow(1 + x, 5) - 1) / 31; };
    const double low = static_cast<double>(i) / 50;
    pearson.add(counts[i], draws * (cumulative(low + 0.02) - cumulative(low)));
  }
  EXPECT_TRUE(pearson.passes()) << pearson.statistic;
}

Prepared law(const std::string& law, const std::string& more = "") {
  return prepare("analytic/law", "{law: " + law + more + "}");
}

// Cells of equal probability by these laws' own quantiles. False alarm 1e-6 each.
TEST(AnalyticLaw, DrawsFollowTheLaw) {
  using Cdf = double (*)(double);
  static const auto phi = [](double z) { return std::erfc(-z / std::sqrt(2.0)) / 2; };
  for (const auto& [name, cdf] : std::map<std::string, Cdf>{
           {"exponential(2)", [](double x) { return -std::expm1(-2 * x); }},
           {"lognormal(1, 0.5)", [](double x) { return phi((std::log(x) - 1) / 0.5); }},
           {"normal(1, 2)", [](double x) { return phi((x - 1) / 2); }},
           // Student's law with 2 and with 1 degrees of freedom has a plain distribution function.
           {"student_t(2)", [](double x) { return (1 + x / std::sqrt(2 + x * x)) / 2; }},
           {"student_t(1)", [](double x) { return 0.5 + std::atan(x) / std::numbers::pi; }},
           {"uniform(-1, 3)", [](double x) { return (x + 1) / 4; }}}) {
    std::vector<double> counts(50);
    const Sample sample = observe(law(name), 50000)[0];
    for (const double x : sample.values) {
      counts[static_cast<std::size_t>(std::min(49.0, 50 * cdf(x)))] += 1;
    }
    EXPECT_TRUE(Pearson::of_equal(counts).passes()) << name;
  }
}

TEST(AnalyticLaw, DeclaresMomentsWhereTheyExistAlone) {
  EXPECT_FALSE(law("student_t(1)").channel().mean);
  EXPECT_EQ(law("student_t(1.5)").channel().mean, 0);
  EXPECT_FALSE(law("student_t(2)").channel().variance);
  EXPECT_EQ(law("student_t(4)").channel().variance, 2);
  EXPECT_EQ(law("exponential(1)").channel().low, 0);
  EXPECT_EQ(law("uniform(1, 2)", ", shift: -1, scale: 2").channel().high, 3);
}

// The draws of its sampler have the density it declares, mass outside included: Simpson's rule.
TEST(AnalyticLaw, SamplersDeclareDensitiesThatIntegrateToTheirMass) {
  for (const char* name :
       {"exponential(1)", "lognormal(0, 0.5)", "normal(0, 1)", "student_t(5)", "uniform(0, 1)"}) {
    const auto plugin = law(name, ", scale: 2");
    const auto sampler = plugin.sampler();
    const double low = sampler->bounds()[0];
    const double width = sampler->bounds()[1] - low;
    const double mass =
        width * simpson([&](double u) { return sampler->density({low + width * u}); });
    int inside = 0;
    constexpr int draws = 20000;
    for (std::uint64_t i = 0; i < draws; ++i) {
      Stream random(plugin.key, i);
      inside += sampler->sample(random).valid ? 1 : 0;
    }
    EXPECT_LE(mass, 1 + 1e-9) << name;
    // False alarm 1e-6 for masses of .99 and more.
    EXPECT_NEAR(inside / double{draws}, mass, five * std::sqrt(0.01 / draws)) << name;
  }
  EXPECT_TRUE(law("bernoulli(0.5)").setup->samplers().empty());
}

TEST(AnalyticMutants, ScaledIsItsOriginalTimesTheFactor) {
  const auto mutant = prepare("mutants/scaled");
  const auto original = prepare("analytic/exponential_uniform");
  EXPECT_EQ(mutant.key, original.key);
  const Sample a = observe(mutant, 100)[0];
  const Sample b = observe(original, 100)[0];
  for (std::size_t i = 0; i < 100; ++i) EXPECT_DOUBLE_EQ(a.values[i], 1.01 * b.values[i]);
}

// Binomial(10000, 0.01): 100 +- five standard deviations of 9.95.
TEST(AnalyticMutants, RareNanSpoilsItsShareAndNothingElse) {
  const auto mutant = prepare("mutants/rare_nan", "{probability: 0.01}");
  const auto original = prepare("analytic/normal");
  EXPECT_EQ(mutant.key, original.key);
  const Sample a = observe(mutant, 10000)[0];
  const Sample b = observe(original, 10000)[0];
  int spoilt = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (std::isnan(a.values[i])) {
      ++spoilt;
    } else {
      EXPECT_EQ(a.values[i], b.values[i]);
    }
  }
  EXPECT_NEAR(spoilt, 100, five * 9.95);
}

}  // namespace
}  // namespace assay
