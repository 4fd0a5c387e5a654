#include "harness/plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/critical.h"
#include "harness/pilot_run.h"
#include "harness/planned_run.h"
#include "questions.h"
#include "refusal.h"
#include "running.h"
#include "stats/assumption_gates.h"
#include "stats/power.h"
#include "stats/tails.h"

namespace assay::harness {
namespace {

/// A suite piloted and planned as a run does it.
struct Planned {
  std::unique_ptr<Asked> asked;
  std::vector<FamilyPlace> place;
  Pilots pilots;
  std::vector<Plan> plans;
};

Planned plan_text(const std::string& tests, std::uint64_t seed = 1) {
  Planned planned{.asked = ask_text(R"(suite: plans
estimators:
  normal: {plugin: analytic/normal, mean: 2}
  coin: {plugin: analytic/law, law: bernoulli(0.5), primaries: 1}
  single: {plugin: analytic/normal, mean: 2, primaries: 1}
  uniform: {plugin: analytic/exponential_uniform}
  flat: {plugin: analytic/law, law: 'uniform(0, 1)', primaries: 1}
  heavy: {plugin: analytic/heavy_tail, index: 3}
  heavy-single: {plugin: analytic/heavy_tail, index: 3, primaries: 1}
  heavier-single: {plugin: analytic/heavy_tail, index: 2.2, primaries: 1}
  hemisphere: {plugin: luminaire/hemisphere, scene: triangle}
  dart: {plugin: analytic/dart_throwing, primaries: 1}
  corners: {plugin: virtual_lights/weighted, primaries: 2}
  same-samples: {plugin: correlated/area_same_samples, scene: rectangle, primaries: 16}
  multi: {plugin: direct_light/multi_sample, primaries: 1}
  ratio: {plugin: analytic/ratio, primaries: 4096}
  unseen: {plugin: analytic/rare_spike, probability: 1e-9, height: 1, primaries: 1}
  far: {plugin: analytic/rare_spike, probability: 1e-12, height: 1e6, primaries: 1}
  spike: {plugin: analytic/rare_spike, probability: 0.0001, height: 10, noise: 0.1, primaries: 1}
tests:
)" + tests)};
  planned.place = places(planned.asked->suite, planned.asked->questions);
  std::vector<const PreparedEstimator*> all;
  for (const auto& [name, estimator] : planned.asked->estimators) all.push_back(&estimator);
  Silence silence;
  planned.pilots = run_pilots(all, pilot_run_of(planned.asked->questions, seed, 1), silence);
  const Primaries primaries =
      choose_primaries(planned.asked->questions, planned.place, planned.pilots);
  for (std::size_t i = 0; i < planned.place.size(); ++i) {
    planned.plans.push_back(
        plan_test(planned.asked->questions[i], planned.place[i], planned.pilots, primaries));
  }
  return planned;
}

TEST(Plan, WithoutDetectIsClassical) {
  const Planned planned = plan_text("  - {claim: mean(normal) == 2}\n");
  EXPECT_EQ(planned.plans[0].most_secondaries(), 1000);
  EXPECT_EQ(planned.plans[0].method.name, "t");
}

// Values in [0.4, 10.6]: whatever their deviation, the empirical bound is at least 7 ln(2 / .01)
// 10.2 / (3 (n - 1)) wide (Maurer and Pontil 2009), below 0.5 from n = 253 on.
TEST(Plan, AMarginIsPlannedByTheMethodThatDecides) {
  const Planned planned = plan_text("  - {claim: mean(spike) within 0.5 of analytic}\n");
  EXPECT_EQ(planned.plans[0].method.name, "bounded");
  EXPECT_GE(planned.plans[0].most_secondaries(), 253);
  EXPECT_LT(planned.plans[0].most_secondaries(), 2530);
}

TEST(Plan, ObeysFixedSecondaries) {
  const Planned planned = plan_text("  - {claim: mean(normal) == 2, secondaries: 123}\n");
  EXPECT_EQ(planned.plans[0].most_secondaries(), 123);
}

// sigma = 1 is known to the pilot of 8192 up to exp(3.09 sqrt(2 / 8192)) - 1 = 4.9 % of the
// variance (its own error as much again): between the n of sigma^2 = 1 and that of 1.12.
TEST(Plan, FindsDetectWithTheSuitesErrorRates) {
  const Planned planned = plan_text("  - {claim: mean(single) == 2, detect: 2%}\n");
  // Doubling from 100 to some 15,000 takes nine looks, each with a ninth of the errors.
  const stats::LookSchedule& looks = planned.plans[0].looks;
  ASSERT_EQ(looks.sizes.size(), 9);
  const stats::ErrorRates rates{.alpha = 0.01 / 9, .beta = 0.01 / 9, .two_sided = true};
  for (std::size_t k = 1; k < 9; ++k) {
    const double growth =
        static_cast<double>(looks.sizes[k]) / static_cast<double>(looks.sizes[k - 1]);
    EXPECT_NEAR(growth, 2, 0.01);
    EXPECT_DOUBLE_EQ(looks.weights[k], 1.0 / 9);
  }
  EXPECT_GE(looks.sizes.front(), 100U);
  const auto exact = [&](double variance) {
    return static_cast<double>(*stats::student_t_sample_size(
        {.standard_deviation = std::sqrt(variance), .rates = rates}, 0.04));
  };
  EXPECT_GE(static_cast<double>(planned.plans[0].most_secondaries()), exact(1));
  EXPECT_LE(static_cast<double>(planned.plans[0].most_secondaries()), exact(1.12));
}

// Two one-sided tests at the last look's share of beta, each missing with half of it: SE = margin /
// (z_b + z_b/2). The variance of ln s2 is (kurtosis - 1) / n, and the pilot of 8192 has a
// kurtosis of 3 +- .054: four of these are 11 % of n, 1e-4.
TEST(Plan, OfWithinGivesBothMarginsTheirShareOfBeta) {
  const Planned planned = plan_text("  - {claim: variance(single) within 25% of 1}\n");
  const stats::LookSchedule& looks = planned.plans[0].looks;
  const double share = 0.01 * looks.weights.back();
  const auto z = [](double p) { return stats::normal_quantile({stats::Tail::upper, std::log(p)}); };
  const double wanted = std::log(1.25) / (z(share) + z(share / 2));
  const auto n = static_cast<double>(planned.plans[0].most_secondaries());
  EXPECT_NEAR(n * wanted * wanted / 2, 1, 0.11);
}

// SE^2 = (.05 / (z_.005 + z_.01))^2 of a median whose spread is sqrt(1 / 4) over the density: 1 on
// the unit interval, where a normal law of the same deviation has 1.38 and too few would be drawn.
// The pilot's count of 410 within .05 is taken two of its errors too low: 11 %, and 1.23 of n.
TEST(Plan, OfAQuantileCountsThePilotsValues) {
  const Planned planned = plan_text("  - {claim: \"quantile(flat, 0.5) == 0.5\", detect: 0.05}\n");
  const double share = 0.01 * planned.plans[0].looks.weights.back();
  const auto z = [](double p) { return stats::normal_quantile({stats::Tail::upper, std::log(p)}); };
  const double wanted = 0.05 / (z(share / 2) + z(share));
  const auto n = static_cast<double>(planned.plans[0].most_secondaries());
  EXPECT_GE(n * wanted * wanted * 4, 1);
  EXPECT_LE(n * wanted * wanted * 4, 1.7);
}

// The reference's error leaves the samples less of the margin: SE^2 = (margin / z)^2 - u^2.
TEST(Plan, OfWithinLeavesRoomForTheReferencesError) {
  const auto secondaries = [](const std::string& reference) {
    const Planned planned =
        plan_text("  - {claim: mean(single) within 0.2 of " + reference + "}\n");
    const double share = 0.01 * planned.plans[0].looks.weights.back();
    const auto z = [](double p) {
      return stats::normal_quantile({stats::Tail::upper, std::log(p)});
    };
    return std::pair(static_cast<double>(planned.plans[0].most_secondaries()),
                     0.2 / (z(share) + z(share / 2)));
  };
  const auto [exact, wanted] = secondaries("2");
  EXPECT_GE(exact, 1 / (wanted * wanted));
  EXPECT_LE(exact, 1.12 / (wanted * wanted) + 3);
  const auto [uncertain, of_both] = secondaries("2 +- 0.025");
  const double left = of_both * of_both - 0.025 * 0.025;
  EXPECT_GE(uncertain, 1 / left);
  EXPECT_LE(uncertain, 1.12 / left + 3);
  EXPECT_NE(refusal([] {
              plan_text("  - {claim: mean(single) within 0.2 of 2 +- 0.1}\n");
            }).find("no number of observations would decide"),
            std::string::npos);
}

TEST(Plan, AsksForMoreAtASmallerShare) {
  const Planned alone = plan_text("  - {claim: mean(single) == 2, detect: 2%}\n");
  const Planned among = plan_text(
      "  - {claim: mean(single) == 2, detect: 2%, weight: 1}\n"
      "  - {name: heavier, claim: mean(single) <= 3, weight: 99}\n");
  EXPECT_GT(among.plans[0].most_secondaries(), alone.plans[0].most_secondaries());
}

TEST(Plan, ChoosesPrimariesAsAPowerOfTwoThatTamesTheTail) {
  const Planned planned = plan_text(
      "  - {name: a, claim: variance(uniform) <= 100}\n"
      "  - {name: b, claim: variance(normal) <= 100}\n");
  const std::uint64_t skewed = planned.plans[0].primaries[0];
  EXPECT_EQ(skewed & (skewed - 1), 0);
  EXPECT_GE(skewed, 64);
  EXPECT_EQ(planned.plans[1].primaries[0], 64) << "a normal primary needs no averaging";
}

TEST(Plan, ObeysFixedPrimaries) {
  const Planned planned = plan_text("  - {claim: mean(single) == 2}\n");
  EXPECT_EQ(planned.plans[0].primaries[0], 1);
}

TEST(Plan, OfADistributionTakesSinglePrimaries) {
  const Planned planned = plan_text(
      "  - {name: a, claim: \"distribution(normal) == normal(2, 1)\"}\n"
      "  - {name: b, claim: mean(normal) == 2}\n");
  EXPECT_EQ(planned.plans[0].primaries[0], 1);
  EXPECT_EQ(planned.plans[1].primaries[0], 64);
}

TEST(Plan, MovesToLogVarianceWhereSecondariesAreNotNormal) {
  const Planned planned = plan_text("  - {claim: variance(uniform) <= 100}\n");
  EXPECT_EQ(planned.plans[0].method.name, "chi-square") << "primaries are chosen so";
  const Planned skewed = plan_text("  - {claim: variance(heavier-single) <= 100}\n");
  EXPECT_EQ(skewed.plans[0].method.name, "log-variance");
  EXPECT_FALSE(skewed.plans[0].invalid.empty())
      << "a Pareto law of index 2.2 has no kurtosis at all";
  EXPECT_NE(skewed.plans[0].invalid.find("tail is too heavy"), std::string::npos);
}

// 8192 primaries see nothing of a spike of probability 1e-9: as many are planned as bound what it
// may add, where that is within reach, and the classical number where it is not.
TEST(Plan, OfAConstantInADeclaredRangeBoundsWhatWasNotSeen) {
  const Planned planned = plan_text(
      "  - {claim: mean(unseen) == 0.5, detect: 1%}\n"
      "  - {name: classical, claim: mean(unseen) == 0.5}\n"
      "  - {claim: mean(far) == 0.5, detect: 1%}\n");
  EXPECT_EQ(planned.plans[0].method.name, "bounded");
  EXPECT_GT(planned.plans[0].most_secondaries(), usual_secondaries);
  // To exclude a mean of .505 by values that are .5 but for 1.5 takes ln(1 / .01) / .005 at least.
  EXPECT_LT(planned.plans[0].most_secondaries(), 10 * 921);
  EXPECT_EQ(planned.plans[1].most_secondaries(), usual_secondaries);
  EXPECT_EQ(planned.plans[2].most_secondaries(), usual_secondaries);
}

// A ratio of sums over 4096 has the shape of a normal law, of which a pilot of 512 shows a kurtosis
// beyond the bound in one of four runs.
TEST(Plan, OfFewNearNormalObservationsChiSquareStands) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Planned few = plan_text("  - {claim: variance(ratio) <= 1, secondaries: 500}\n", seed);
    EXPECT_EQ(few.plans[0].method.name, "chi-square") << seed;
    EXPECT_EQ(few.plans[0].invalid, "") << seed;
  }
  const Planned skewed = plan_text("  - {claim: variance(corners) <= 100, secondaries: 500}\n");
  EXPECT_NE(skewed.plans[0].invalid, "");
}

// Each allows for the kurtosis that the pilot cannot exclude, where that is beyond what it bears:
// of 512 values some .36, of 8192 primaries in means of 64 next to nothing. A forced one does not.
TEST(Plan, OfFewNearNormalObservationsTheirKurtosisIsAllowedFor) {
  const Planned planned = plan_text(
      "  - {name: few, claim: variance(ratio) <= 1, secondaries: 500}\n"
      "  - {name: forced, claim: variance(ratio) <= 1, secondaries: 500, test: chi-square}\n"
      "  - {name: averaged, claim: variance(normal) <= 100, secondaries: 500}\n"
      "  - {name: one of two, claim: variance(normal) < variance(ratio), secondaries: 500}\n");
  const auto allowed = [&](std::size_t test) {
    return planned.plans[test].method.frozen.excess_kurtosis(0);
  };
  const Pilot& pilot = *pilot_of(planned.asked->questions[0].subjects[0], planned.pilots);
  const double limit = stats::kurtosis_upper_limit(pilot.sums->moments(0));
  EXPECT_GT(limit, 0.2);
  EXPECT_EQ(allowed(0).x, limit);
  EXPECT_EQ(allowed(1).x, 0);
  EXPECT_EQ(allowed(2).x, 0);
  EXPECT_EQ(planned.plans[3].method.name, "F");
  EXPECT_EQ(allowed(3).x, 0);
  EXPECT_EQ(allowed(3).y, limit);
}

// Variances of eight fair coins are skewed to the left (-2.2), and so is their mean's logarithm: of
// 1000 coins `<=` failed at .001 eight times too often. Of normal values they are not.
TEST(Plan, OfTotalVariancesTheGroupsAreNearNormal) {
  const Planned planned = plan_text(
      "  - {name: coin, claim: total_variance(coin) <= 0.25}\n"
      "  - {name: normal, claim: total_variance(single) <= 1}\n");
  EXPECT_GT(planned.plans[0].most_secondaries(), 10000);
  EXPECT_LT(planned.plans[1].most_secondaries(), 2 * usual_secondaries);
  EXPECT_EQ(planned.plans[0].invalid, "");
}

// What is drawn decides nothing: no more of it than a test without `detect` takes.
TEST(Plan, OfAClaimThatIsInvalidDrawsLittle) {
  const Planned planned = plan_text(
      "  - {claim: variance(heavier-single) <= 100, detect: 1%}\n"
      "  - {name: as many as asked for, claim: variance(heavier-single) <= 100, secondaries: "
      "2000}\n");
  ASSERT_FALSE(planned.plans[0].invalid.empty());
  EXPECT_EQ(planned.plans[0].looks.sizes, std::vector<std::uint64_t>{usual_secondaries});
  EXPECT_EQ(planned.plans[1].looks.sizes, std::vector<std::uint64_t>{2000});
}

// Both show a heavy tail in the 512 values of their pilots, with kurtoses of some 500 and of 23; in
// 400,000 values the second has one of 24.
TEST(Plan, OfFewValuesATailIsHeavyWhereTheKurtosisIsToo) {
  const Planned heavy = plan_text("  - {claim: variance(corners) <= 100}\n");
  EXPECT_NE(heavy.plans[0].invalid.find("tail is too heavy"), std::string::npos);
  const Planned light = plan_text("  - {claim: variance(same-samples) <= 100}\n");
  EXPECT_EQ(light.plans[0].invalid, "");
}

// Two rays, and one where the first finds nothing: a skewness of -6.5.
TEST(Plan, SkewedCostsTakeMoreObservations) {
  const Planned open = plan_text("  - {claim: cost(multi) <= 2}\n");
  EXPECT_GT(open.plans[0].most_secondaries(), 5000);
  EXPECT_EQ(open.plans[0].invalid, "");
  const Planned fixed = plan_text("  - {claim: cost(multi) <= 2, secondaries: 1000}\n");
  EXPECT_NE(fixed.plans[0].invalid.find("costs of this shape"), std::string::npos);
  const Planned constant = plan_text("  - {claim: cost(hemisphere) <= 2, secondaries: 100}\n");
  EXPECT_EQ(constant.plans[0].invalid, "");
}

// A Pareto law of index 3 shows a skewness of some 5 in its pilot: the t test is right within a
// quarter from some 10,000 values on, the corrected one from some 1000.
TEST(Plan, CorrectsForSkewnessWhereTheTTestWouldNeedMore) {
  const Planned heavy = plan_text("  - {claim: mean(heavy-single) == 1.5, secondaries: 3000}\n");
  EXPECT_EQ(heavy.plans[0].method.name, "skewness-corrected-t");
  const Planned normal = plan_text("  - {claim: mean(normal) == 2, secondaries: 300}\n");
  EXPECT_EQ(normal.plans[0].method.name, "t");
}

// One look decides at z = 5.0 errors of the reference, ten looks would take 6.9 of them.
TEST(Plan, TakesFewerLooksWhereTheReferencesErrorAllowsNoMore) {
  const Planned planned = plan_text("  - {claim: mean(single) == 2 +- 0.001, detect: 0.0055}\n");
  EXPECT_LT(planned.plans[0].most_secondaries(), 1e8);
  EXPECT_LT(planned.plans[0].looks.sizes.size(), 10);
}

TEST(Plan, IsInvalidWhereAFixedSizeIsTooSmallForAnyMethod) {
  const Planned planned = plan_text("  - {claim: mean(heavy-single) == 1.5, secondaries: 30}\n");
  EXPECT_NE(planned.plans[0].invalid.find("keeps its level"), std::string::npos);
}

TEST(Plan, CountsValuesOfWhichThereAreTwo) {
  const Planned planned = plan_text("  - {claim: mean(dart) == 3.14159, secondaries: 300}\n");
  EXPECT_EQ(planned.plans[0].method.name, "binomial");
}

TEST(Plan, ForcedMethodStandsWithItsGatesShown) {
  const Planned planned =
      plan_text("  - {claim: variance(heavy-single) <= 100, test: chi-square}\n");
  EXPECT_EQ(planned.plans[0].method.name, "chi-square");
  EXPECT_TRUE(planned.plans[0].invalid.empty());
  const std::vector<reports::Gate>& gates = planned.plans[0].gates;
  EXPECT_TRUE(std::any_of(gates.begin(), gates.end(), [](const reports::Gate& gate) {
    return gate.name.starts_with("excess kurtosis") && gate.state == "red";
  }));
}

// A logarithm asks for no normal values, but for more of them than a thousand where they are
// skewed.
TEST(Plan, AForcedLogarithmShowsThatItHasTooFewValues) {
  const auto too_few = [](const std::string& test) {
    const Planned planned = plan_text("  - {" + test + ", secondaries: 1000}\n");
    EXPECT_EQ(planned.plans[0].invalid, "") << test;
    EXPECT_EQ(planned.plans[0].most_secondaries(), 1000) << test;
    return std::any_of(planned.plans[0].gates.begin(), planned.plans[0].gates.end(),
                       [](const reports::Gate& gate) {
                         return gate.name.starts_with("number of observations") &&
                                gate.state == "red";
                       });
  };
  EXPECT_TRUE(too_few("claim: variance(heavy-single) <= 100, test: log-variance"));
  EXPECT_TRUE(too_few("claim: total_variance(heavy-single) <= 100, test: log-total-variance"));
  EXPECT_TRUE(too_few("claim: cost(multi) <= 2, test: log-cost"));
  EXPECT_FALSE(too_few("claim: variance(normal) <= 100, test: log-variance"));
  EXPECT_FALSE(too_few("claim: cost(hemisphere) <= 2, test: log-cost"));
}

// Of the mean of `corners` 512 values of its pilot are known, of its variance 8192, the same 512
// among them. `ratio` is near normal, and who asks for 600 observations needs no more.
TEST(Plan, OfAVarianceFarFromNormalThePilotIsLarger) {
  const Workplace place;
  const auto piloted = [&](const std::string& tests, RunOptions options = {}) {
    Silence silence;
    return plan_run({load_suite(place.write("pilots.yaml", R"(suite: pilots
estimators:
  corners: {plugin: virtual_lights/weighted, primaries: 2}
  fewer: {plugin: virtual_lights/weighted, primaries: 2}
  ratio: {plugin: analytic/ratio, primaries: 1024}
tests:
  - {name: mean, claim: mean(corners) == analytic}
)" + tests))},
                    options, silence);
  };
  const std::string variances = R"(  - {name: corners, claim: variance(corners) <= 100}
  - {name: fewer, claim: variance(fewer) <= 100, secondaries: 600}
  - {name: ratio, claim: variance(ratio) <= 100}
)";
  const PlannedRun planned = piloted(variances, {.threads = 1});
  const SuiteRun& run = *planned.suites[0];
  const Pilot& corners = run.pilots.at("corners");
  ASSERT_NE(corners.larger, nullptr);
  EXPECT_EQ(corners.values[0].size(), 512);
  ASSERT_EQ(corners.larger->values[0].size(), 8192);
  EXPECT_TRUE(std::equal(corners.values[0].begin(), corners.values[0].end(),
                         corners.larger->values[0].begin()));
  EXPECT_EQ(pilot_of(run.tests[0].outcome.question, 0, run.pilots), &corners);
  EXPECT_EQ(pilot_of(run.tests[1].outcome.question, 0, run.pilots), corners.larger.get());
  ASSERT_NE(run.pilots.at("fewer").larger, nullptr);
  EXPECT_EQ(run.pilots.at("fewer").larger->values[0].size(), 2048) << "the least that tells";
  EXPECT_EQ(run.pilots.at("ratio").larger, nullptr);

  const PlannedRun again = piloted(variances, {.threads = 4, .filter = "pilots/corners"});
  const Pilot& alone = again.suites[0]->pilots.at("corners");
  ASSERT_NE(alone.larger, nullptr);
  EXPECT_EQ(alone.larger->values, corners.larger->values);
  EXPECT_EQ(alone.larger->moments(0).m4, corners.larger->moments(0).m4);

  const PlannedRun means = piloted(variances, {.filter = "pilots/mean"});
  EXPECT_EQ(means.suites[0]->pilots.at("corners").larger, nullptr) << "no such test is chosen";
}

TEST(Plan, StaysWithinABudgetOfPrimaries) {
  const Planned planned = plan_text("  - {claim: mean(single) == 2, detect: 0.1%, budget: 5000}\n");
  EXPECT_EQ(planned.plans[0].most_secondaries(), 5000);
}

TEST(Plan, DoesNotDependOnWhichOtherTestsAreThere) {
  const Planned one = plan_text(
      "  - {claim: mean(single) == 2, detect: 2%, weight: 1}\n"
      "  - {name: b, claim: mean(uniform) <= 7}\n");
  const Planned other = plan_text(
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
