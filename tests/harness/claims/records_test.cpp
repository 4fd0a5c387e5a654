// Claims of every kind: what is shared, and what their records say. Their verdicts are in
// tests/tables/verdicts.txt, and levels in levels.txt.

#include "harness/draws/sampler_setup.h"
#include "harness/sampling/summary.h"
#include "stats/variances/group_variance.h"
#include "tests/harness/prelude.h"
#include "tests/harness/table.h"

namespace assay::harness {
namespace {

reports::Test tested(const std::string& test) { return run_test(suite_with("claims", test)); }

TEST(MoreClaims, OfAFactorSayWhatTheEffectIsAgainst) {
  const auto quantity = [](const std::string& claim) {
    return tested("{claim: '" + claim + "', secondaries: 500}").channels[0].effect.quantity;
  };
  EXPECT_EQ(quantity("variance(uniform) < 2 * variance(scaled)"),
            "ln(ratio of variances (the second times 2))");
  EXPECT_EQ(quantity("mean(uniform) == 0.5 * mean(scaled)"),
            "relative difference of means (the second times 0.5)");
  EXPECT_EQ(quantity("mean(uniform) == mean(scaled)"), "relative difference of means");
}

// Zeros and ones in equal number have kurtosis 1, and rounding takes it below 1. That must not end
// the run with an error.
TEST(MoreClaims, AVarianceOfTwoValuesIsComparedWhateverItsRounding) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const reports::Test test = run_test(
        "suite: coins\nalpha: 1e-6\nestimators:\n"
        "  normal: {plugin: analytic/normal, deviation: 0.5, primaries: 1}\n"
        "  coin: {plugin: analytic/law, law: bernoulli(0.5), primaries: 1}\n"
        "tests: [{claim: variance(normal) == variance(coin), secondaries: 16, test: F}]\n",
        {.seed = seed});
    EXPECT_NE(test.verdict, reports::Verdict::error) << seed << " " << test.message;
  }
}

// Their kurtosis is 1 whatever the law: what would have been found is not known, and not asked for.
TEST(MoreClaims, OfAVarianceFromTwoObservationsSayNothingOfPower) {
  for (const char* claim :
       {"variance(n) <= 100", "variance(n) == 1", "variance(n) < variance(w)"}) {
    const reports::Test test = run_test(std::string("suite: s\nestimators:\n"
                                                    "  n: {plugin: analytic/normal}\n"
                                                    "  w: {plugin: analytic/normal, deviation: 9}\n"
                                                    "tests:\n  - {claim: '") +
                                        claim + "', secondaries: 2}\n");
    EXPECT_NE(test.verdict, reports::Verdict::error) << claim;
    EXPECT_FALSE(test.detectable) << claim;
  }
}

TEST(BiasClaim, ShowsTheReferenceOfTheTest) {
  const reports::Test shown =
      tested("{claim: bias(uniform) == 0, reference: 6.36 +- 0.01, detect: 0.2}");
  EXPECT_EQ(shown.verdict, Verdict::pass);
  EXPECT_EQ(shown.null_hypothesis, "bias(uniform) = 0, reference 6.36");
  EXPECT_EQ(shown.reference, "6.36 +- 0.01");
}

TEST(Budget, PaysForAPilotAndTwoObservations) {
  const reports::Test least = tested("{claim: mean(uniform) == analytic, budget: 279}");
  EXPECT_EQ(least.samples[0].secondaries, 2u);
}

TEST(CostClaim, InSecondsTellsAFactorOfManyAndMarksTheRun) {
  // 64 primaries that trace a ray against one normal number.
  const reports::Record record =
      run_text(suite_with("claims", "{claim: cost(area) > 1.5 * cost(normal), cost: seconds}"));
  EXPECT_EQ(record.suites[0].tests[0].method, "replicates");
  EXPECT_TRUE(record.suites[0].timed);
}

// The number that the quantile is held against stands among the observations.
TEST(QuantileClaim, MarksItsNumberInTheHistogram) {
  const reports::Test test = tested("{claim: \"quantile(normal, 0.5) == 2\", detect: 0.2}");
  EXPECT_EQ(test.channels[0].reference, 2);
}

TEST(GroupVariance, OfTwoEqualChannelsIsTwiceTheSampleVarianceOfTheGroup) {
  stats::GroupVariance groups({0, 2});
  stats::Moments one;
  std::optional<double> total;
  for (int i = 0; i < 8; ++i) {
    const double value = 1e6 + i * i;
    const double values[] = {value, 77, value};
    one.add(value);
    EXPECT_FALSE(total.has_value());
    total = groups.add(values);
  }
  ASSERT_TRUE(total.has_value());
  EXPECT_NEAR(*total, 2 * one.variance(), 1e-9 * one.variance());
}

// Two entries of one plugin share a pool. A claim that needs no density draws it first; its draws
// are still counted in the cells of the density. Two suites of one run do the same.
TEST(CellsOfADensity, AreCountedWhoeverElseDrawsOfThePool) {
  const std::string head =
      "suite: s\nestimators:\n  a: {plugin: brdf/ward}\n  b: {plugin: brdf/ward}\ntests:\n";
  const std::string law =
      "  - {name: law, claim: 'distribution(a.direction.phi) == uniform(0, 6.283185307179586)', "
      "secondaries: 2000}\n";
  const std::string cells =
      "  - {name: cells, claim: distribution(b.direction) == density, secondaries: 2000}\n";
  const std::string whole =
      "  - {name: whole, claim: integral(b.direction) == 1, secondaries: 2000}\n";
  const Workplace place;
  const std::string alone = place.write("alone.yaml", head + cells + whole);
  const std::string other = place.write("other.yaml", head + law);
  const reports::Suite expected = run_files({alone}).suites[0];
  EXPECT_EQ(expected.tests[0].verdict, Verdict::pass) << expected.tests[0].message;
  const auto expect_same = [&](const reports::Test& test, const reports::Test& as) {
    EXPECT_EQ(test.verdict, as.verdict) << test.message;
    EXPECT_EQ(test.channels.at(0).statistic, as.channels.at(0).statistic) << test.name;
    EXPECT_EQ(test.channels.at(0).log10_p, as.channels.at(0).log10_p) << test.name;
  };
  const std::string together = place.write("together.yaml", head + law + cells + whole);
  const reports::Suite shared = run_files({together}).suites[0];
  const reports::Record both = run_files({other, alone});
  for (std::size_t i = 0; i < 2; ++i) {
    expect_same(shared.tests[i + 1], expected.tests[i]);
    expect_same(both.suites[1].tests[i], expected.tests[i]);
  }
}

TEST(InconsistencyClaim, OfADrawIsTheLargerOfTwoRelativeDifferences) {
  class One final : public Sampler {
   public:
    explicit One(const SamplerDraw& draw) : draw_(draw) {}
    Domain domain() const override { return Domain::interval; }
    SamplerDraw sample(Stream&) const override { return draw_; }
    double density(const Point&) const override { return 2; }
    double evaluate(const Point&) const override { return 3; }

   private:
    SamplerDraw draw_;
  };
  const auto difference = [](const SamplerDraw& draw) {
    const ConsistencySetup setup({.name = "one", .sampler = std::make_shared<One>(draw)});
    std::vector<double> out(2);
    Stream random({}, 0);
    Cost cost;
    setup.make()->secondary(random, 1, out, cost);
    return out[1];
  };
  EXPECT_EQ(difference({.density = 2, .weight = 1.5}), 0);
  EXPECT_NEAR(difference({.density = 2.2, .weight = 1.5}), 0.2 / 2.2, 1e-15);
  EXPECT_NEAR(difference({.density = 2, .weight = 3}), 0.5, 1e-15);
  EXPECT_EQ(difference({.weight = 0, .valid = false}), 0);
  EXPECT_TRUE(std::isinf(difference({.weight = 1, .valid = false})));
  EXPECT_TRUE(std::isnan(difference({.density = 2, .weight = std::nan("")})));
}

TEST(EmpiricalLaws, AreInTheRecordOfEveryTestOfValues) {
  const reports::Test one =
      tested("{claim: 'distribution(normal) == normal(2, 1)', secondaries: 500}");
  ASSERT_EQ(one.channels[0].laws.size(), 1U);
  const reports::EmpiricalLaw& law = one.channels[0].laws[0];
  EXPECT_EQ(law.source, "normal");
  EXPECT_EQ(law.points.size(), 63U);
  double before = 0;
  for (const reports::LawPoint& point : law.points) {
    EXPECT_GT(point.observed, before);
    before = point.observed;
    EXPECT_LE(point.low, *point.law) << "at 1e-4 the band holds the law, but once in 1e4 seeds";
    EXPECT_GE(point.high, *point.law);
    EXPECT_NEAR(*point.law, std::erfc((2 - point.value) / std::sqrt(2)) / 2, 1e-12);
  }
  // There scipy.stats.kstwo.sf(…, 500) is 1e-4.
  EXPECT_NEAR(law.points[31].high - law.points[31].observed, 0.0990963115043131, 1e-12);
  const reports::Test two = tested(
      "{claim: distribution(ward.direction.theta) == distribution(redrawn.direction.theta), "
      "secondaries: 500}");
  ASSERT_EQ(two.channels[0].laws.size(), 2U);
  EXPECT_FALSE(two.channels[0].laws[1].points[0].law.has_value());
  EXPECT_GE(two.channels[0].laws[0].points[0].value, 0) << "draws without a point are left out";
  EXPECT_TRUE(tested("{claim: mean(normal) == 2}").channels[0].laws.empty());
}

}  // namespace
}  // namespace assay::harness
