#include "harness/plan/plan.h"

#include "harness/plan/sizes.h"
#include "harness/run/planned_run.h"
#include "stats/planning/power.h"
#include "stats/tails/tails.h"
#include "tests/harness/planned.h"
#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

TEST(Plan, WithoutDetectIsClassical) {
  const Prepared planned = plan_text("  - {claim: mean(normal) == 2}\n");
  EXPECT_EQ(planned.plans[0].most_secondaries(), 1000);
  EXPECT_EQ(planned.plans[0].method.name, "t");
}

// Values lie in [0.4, 10.6], nearly all at 0.5. A value there takes 0.5 / 9.6 of the stake from
// "the mean is 0.5 too large". So 152 values turn a bet into ln(100 x 23), and one of them is a
// spike once in 10,000.
TEST(Plan, AMarginIsPlannedByTheMethodThatDecides) {
  const Prepared planned = plan_text("  - {claim: mean(spike) within 0.5 of analytic}\n");
  EXPECT_EQ(planned.plans[0].method.name, "betting");
  EXPECT_GE(planned.plans[0].most_secondaries(), 152);
  EXPECT_LT(planned.plans[0].most_secondaries(), 1520);
}

TEST(Plan, ObeysFixedSecondaries) {
  const Prepared planned = plan_text("  - {claim: mean(normal) == 2, secondaries: 123}\n");
  EXPECT_EQ(planned.plans[0].most_secondaries(), 123);
}

// A pilot of 8192 knows the variance 1 up to exp(3.09 sqrt(2 / 8192)) - 1 = 4.9 %. Its own error
// is as much. So n lies between that of variance 1 and that of 1.12.
TEST(Plan, FindsDetectWithTheSuitesErrorRates) {
  const Prepared planned = plan_text("  - {claim: mean(single) == 2, detect: 0.3%}\n");
  const stats::LookSchedule& looks = planned.plans[0].looks;
  EXPECT_EQ(looks.law, stats::LookLaw::independent_increments);
  const stats::ErrorRates rates{
      .alpha = looks.alpha.back(), .beta = looks.beta.back(), .two_sided = true};
  for (std::size_t k = 1; k < looks.count(); ++k) {
    const double growth =
        static_cast<double>(looks.sizes[k]) / static_cast<double>(looks.sizes[k - 1]);
    EXPECT_NEAR(growth, std::numbers::sqrt2, 0.04);
    EXPECT_LE(growth, std::numbers::sqrt2 + 1e-4);
    EXPECT_GT(looks.alpha[k], looks.alpha[k - 1]);
  }
  EXPECT_GE(looks.sizes.front(), floor_of_evidence);
  const auto exact = [&](double variance) {
    return static_cast<double>(*stats::student_t_sample_size(
        {.standard_deviation = std::sqrt(variance), .rates = rates}, 0.006));
  };
  EXPECT_GE(static_cast<double>(planned.plans[0].most_secondaries()), exact(1));
  EXPECT_LE(static_cast<double>(planned.plans[0].most_secondaries()), exact(1.12));
}

// Two one-sided tests share the last look's beta, each with half of it: SE = margin / (z_b +
// z_b/2). The variance of ln s2 is (kurtosis - 1) / n. A pilot of 8192 has a kurtosis of 3 +- .054;
// four of these are 11 % of n, 1e-4.
TEST(Plan, OfWithinGivesBothMarginsTheirShareOfBeta) {
  const Prepared planned = plan_text("  - {claim: variance(single) within 2% of 1}\n");
  const double share = planned.plans[0].looks.beta.back();
  const auto z = [](double p) { return stats::normal_quantile({stats::Tail::upper, std::log(p)}); };
  const double wanted = std::log(1.02) / (z(share) + z(share / 2));
  const auto n = static_cast<double>(planned.plans[0].most_secondaries());
  EXPECT_NEAR(n * wanted * wanted / 2, 1, 0.11);
}

// SE^2 = (.05 / (z_.005 + z_.01))^2 of a median whose spread is sqrt(1 / 4) over the density. The
// density is 1 on the unit interval; a normal law of that deviation has 1.38. The pilot counts 410
// within .05, less two errors: 11 %, and 1.23 of n.
TEST(Plan, OfAQuantileCountsThePilotsValues) {
  const Prepared planned = plan_text("  - {claim: \"quantile(flat, 0.5) == 0.5\", detect: 0.05}\n");
  const stats::LookSchedule& looks = planned.plans[0].looks;
  const auto z = [](double p) { return stats::normal_quantile({stats::Tail::upper, std::log(p)}); };
  const double wanted = 0.05 / (z(looks.alpha.back() / 2) + z(looks.beta.back()));
  const auto n = static_cast<double>(planned.plans[0].most_secondaries());
  EXPECT_GE(n * wanted * wanted * 4, 1);
  EXPECT_LE(n * wanted * wanted * 4, 1.7);
}

// The reference's error leaves the samples less of the margin: SE^2 = (margin / z)^2 - u^2.
TEST(Plan, OfWithinLeavesRoomForTheReferencesError) {
  const auto secondaries = [](const std::string& reference) {
    const Prepared planned =
        plan_text("  - {claim: mean(single) within 0.02 of " + reference + "}\n");
    const double share = planned.plans[0].looks.beta.back();
    const auto z = [](double p) {
      return stats::normal_quantile({stats::Tail::upper, std::log(p)});
    };
    return std::pair(static_cast<double>(planned.plans[0].most_secondaries()),
                     0.02 / (z(share) + z(share / 2)));
  };
  const auto [exact, wanted] = secondaries("2");
  EXPECT_GE(exact, 1 / (wanted * wanted));
  EXPECT_LE(exact, 1.12 / (wanted * wanted) + 3);
  const auto [uncertain, of_both] = secondaries("2 +- 0.0025");
  const double left = of_both * of_both - 0.0025 * 0.0025;
  EXPECT_GE(uncertain, 1 / left);
  EXPECT_LE(uncertain, 1.12 / left + 3);
  EXPECT_THAT(refusal([] { plan_text("  - {claim: mean(single) within 0.02 of 2 +- 0.01}\n"); }),
              testing::HasSubstr("no number of observations would decide"));
}

TEST(Plan, AsksForMoreAtASmallerShare) {
  const Prepared alone = plan_text("  - {claim: mean(single) == 2, detect: 0.3%}\n");
  const Prepared among = plan_text(
      "  - {claim: mean(single) == 2, detect: 0.3%, weight: 1}\n"
      "  - {name: heavier, claim: mean(single) <= 3, weight: 99}\n");
  EXPECT_GT(among.plans[0].most_secondaries(), alone.plans[0].most_secondaries());
}

TEST(Plan, ChoosesPrimariesAsAPowerOfTwoThatTamesTheTail) {
  const Prepared planned = plan_text(
      "  - {name: a, claim: variance(uniform) <= 100}\n"
      "  - {name: b, claim: variance(normal) <= 100}\n");
  const std::uint64_t skewed = planned.plans[0].primaries[0];
  EXPECT_EQ(skewed & (skewed - 1), 0);
  EXPECT_GE(skewed, 64);
  EXPECT_EQ(planned.plans[1].primaries[0], 64) << "a normal primary needs no averaging";
}

TEST(Plan, ObeysFixedPrimaries) {
  const Prepared planned = plan_text("  - {claim: mean(single) == 2}\n");
  EXPECT_EQ(planned.plans[0].primaries[0], 1);
}

TEST(Plan, OfADistributionTakesSinglePrimaries) {
  const Prepared planned = plan_text(
      "  - {name: a, claim: \"distribution(normal) == normal(2, 1)\"}\n"
      "  - {name: b, claim: mean(normal) == 2}\n");
  EXPECT_EQ(planned.plans[0].primaries[0], 1);
  EXPECT_EQ(planned.plans[1].primaries[0], 64);
}

TEST(Plan, MovesToInfluenceValuesWhereSecondariesAreNotNormal) {
  const Prepared planned = plan_text("  - {claim: variance(uniform) <= 100}\n");
  EXPECT_EQ(planned.plans[0].method.name, "chi-square") << "primaries are chosen so";
  const Prepared skewed = plan_text("  - {claim: variance(heavier-single) <= 100}\n");
  EXPECT_EQ(skewed.plans[0].method.name, "influence-t");
  EXPECT_EQ(skewed.plans[0].invalid, "") << "what no pilot knows the test's own data gate";
}

// 8192 primaries miss a spike of probability 1e-9. The plan takes as many as bound its
// contribution, a million at most.
TEST(Plan, OfAConstantInADeclaredRangeBoundsWhatWasNotSeen) {
  const Prepared planned = plan_text(
      "  - {claim: mean(unseen) == 0.5, detect: 1%}\n"
      "  - {name: classical, claim: mean(unseen) == 0.5}\n"
      "  - {claim: mean(far) == 0.5, detect: 1%}\n");
  EXPECT_EQ(planned.plans[0].method.name, "betting");
  EXPECT_GT(planned.plans[0].most_secondaries(), usual_secondaries);
  // To exclude a mean of .505 by values that are .5 but for 1.5 takes ln(1 / .01) / .005 at least.
  EXPECT_LT(planned.plans[0].most_secondaries(), 10 * 921);
  EXPECT_EQ(planned.plans[1].most_secondaries(), floor_of_evidence);
  EXPECT_EQ(planned.plans[2].most_secondaries(), 1024 * usual_secondaries);
}

// A Pareto law of index 3 has a skewness of some 5 in its pilot. The t test is right within a
// quarter from some 10,000 values on, the corrected test from some 1000.
TEST(Plan, CorrectsForSkewnessWhereTheTTestWouldNeedMore) {
  const Prepared heavy = plan_text("  - {claim: mean(heavy-single) == 1.5, secondaries: 3000}\n");
  EXPECT_EQ(heavy.plans[0].method.name, "skewness-corrected-t");
  const Prepared normal = plan_text("  - {claim: mean(normal) == 2, secondaries: 300}\n");
  EXPECT_EQ(normal.plans[0].method.name, "t");
}

// One look decides at z = 4.9 errors of the reference, sixteen looks would take 5.1 of them.
TEST(Plan, TakesFewerLooksWhereTheReferencesErrorAllowsNoMore) {
  const Prepared planned = plan_text("  - {claim: mean(single) == 2 +- 0.001, detect: 0.005}\n");
  EXPECT_LT(planned.plans[0].most_secondaries(), 1e8);
  EXPECT_LT(planned.plans[0].looks.count(), most_looks);
}

// 2^14 primaries, in observations of one or of 64. Rows of a file and bets have no floor.
TEST(Plan, OfAMeanWithoutARangeBeginsAtTheFloor) {
  const Prepared planned = plan_text(
      "  - {claim: mean(single) == 2, detect: 50%}\n"
      "  - {claim: mean(normal) == 2, detect: 50%}\n"
      "  - {claim: mean(spike) == analytic, detect: 50%}\n"
      "  - {name: fixed, claim: mean(single) == 2, secondaries: 300}\n");
  EXPECT_EQ(planned.plans[0].looks.sizes.front(), floor_of_evidence);
  EXPECT_EQ(planned.plans[1].looks.sizes.front(), floor_of_evidence / 64);
  EXPECT_LT(planned.plans[2].looks.sizes.front(), floor_of_evidence);
  EXPECT_EQ(planned.plans[3].looks.sizes.front(), 300U) << "somebody said so";
}

TEST(Plan, CountsValuesOfWhichThereAreTwo) {
  const Prepared planned = plan_text("  - {claim: mean(dart) == 3.14159, secondaries: 300}\n");
  EXPECT_EQ(planned.plans[0].method.name, "binomial");
}

TEST(Plan, ForcedMethodStandsWithItsGatesShown) {
  const Prepared planned =
      plan_text("  - {claim: variance(heavy-single) <= 100, test: chi-square}\n");
  EXPECT_EQ(planned.plans[0].method.name, "chi-square");
  EXPECT_TRUE(planned.plans[0].invalid.empty());
  const std::vector<Gate>& gates = planned.plans[0].gates;
  EXPECT_TRUE(std::any_of(gates.begin(), gates.end(), [](const reports::Gate& gate) {
    return gate.name.starts_with("upper limit of the excess kurtosis") && gate.state == "amber";
  }));
}

// 2^14 primaries make 2048 observations of 8, and no fewer than 512 of 1024.
TEST(Plan, APilotIsTheSameWhateverIsClaimed) {
  const Workplace place;
  const auto values = [&](const std::string& claim, const std::string& estimator) {
    Silence silence;
    const PlannedRun planned = plan_run({load_suite(place.write("pilots.yaml", R"(suite: pilots
estimators:
  corners: {plugin: virtual_lights/weighted, primaries: 8}
  ratio: {plugin: analytic/ratio, primaries: 1024}
tests:
  - claim: )" + claim + "\n"))},
                                        {.threads = 1}, silence);
    return planned.suites[0]->pilots.at(estimator).values[0];
  };
  const std::vector<double> of_mean = values("mean(corners) == analytic", "corners");
  EXPECT_EQ(of_mean.size(), 2048);
  EXPECT_EQ(values("variance(corners) <= 100", "corners"), of_mean);
  EXPECT_EQ(values("variance(ratio) <= 100", "ratio").size(), 512);
}

TEST(Plan, StaysWithinABudgetOfPrimaries) {
  const Prepared planned =
      plan_text("  - {claim: mean(single) == 2, detect: 0.1%, budget: 5000}\n");
  EXPECT_EQ(planned.plans[0].most_secondaries(), 5000);
}

TEST(Plan, DoesNotDependOnWhichOtherTestsAreThere) {
  const Prepared one = plan_text(
      "  - {claim: mean(single) == 2, detect: 2%, weight: 1}\n"
      "  - {name: b, claim: mean(uniform) <= 7}\n");
  const Prepared other = plan_text(
      "  - {claim: mean(single) == 2, detect: 2%, weight: 1}\n"
      "  - {name: b, claim: variance(hemisphere) <= 7}\n");
  EXPECT_EQ(one.plans[0].most_secondaries(), other.plans[0].most_secondaries());
}

TEST(Plan, PilotIsOfTheSeedAlone) {
  const std::string test = "  - {claim: mean(single) == 2}\n";
  const stats::Moments one = plan_text(test).pilots.at("single").moments(0);
  EXPECT_EQ(plan_text(test).pilots.at("single").moments(0), one);
  EXPECT_NE(plan_text(test, 2).pilots.at("single").moments(0).mean, one.mean);
  EXPECT_EQ(plan_text(test).pilots.at("single").moments(0).mean,
            plan_text(test).pilots.at("normal").moments(0).mean)
      << "the same plugin and parameters at one primary";
}

TEST(Plan, CriticalValueIsTheNormalQuantile) {
  EXPECT_NEAR(critical_value(0.05, true), 1.959964, 1e-6);
  EXPECT_NEAR(critical_value(0.05, false), 1.644854, 1e-6);
}

}  // namespace
}  // namespace assay::harness
