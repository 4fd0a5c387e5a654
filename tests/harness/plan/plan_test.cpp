#include "harness/plan/plan.h"

#include "harness/plan/outcome.h"
#include "harness/run/planned_run.h"
#include "stats/planning/power.h"
#include "stats/tails/tails.h"
#include "tests/harness/planned.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

/// If the number is as the table says: `-`, a number, or `A..B`.
bool is_in(std::uint64_t number, const std::string& range) {
  const std::size_t dots = range.find("..");
  const double low = range == "-" ? 0 : std::stod(range);
  const double high = range == "-"         ? 1e300
                      : dots == range.npos ? low
                                           : std::stod(range.substr(dots + 2));
  return static_cast<double>(number) >= low && static_cast<double>(number) <= high;
}

TEST(Plan, IsAsTheTableSays) {
  const ClaimSection plans = sections_of("plans.txt").at(0);
  EXPECT_GT(plans.rows.size(), 30U);
  for (const ClaimRow& row : plans.rows) {
    std::istringstream words(row.text);
    std::string method, most, first, primaries, claim;
    words >> method >> most >> first >> primaries >> std::ws;
    std::getline(words, claim);
    const Prepared planned = plan_text("  - " + claim + "\n");
    const Plan& plan = planned.plans[0];
    EXPECT_EQ(plan.invalid.text, "") << claim;
    EXPECT_TRUE(method == "-" || plan.method.name == method) << claim << ": " << plan.method.name;
    EXPECT_TRUE(is_in(plan.most_secondaries(), most)) << claim << ": " << plan.most_secondaries();
    EXPECT_TRUE(is_in(plan.looks.sizes.front(), first)) << claim << ": " << plan.looks.sizes[0];
    EXPECT_TRUE(is_in(plan.primaries[0], primaries)) << claim << ": " << plan.primaries[0];
    EXPECT_TRUE(std::has_single_bit(plan.primaries[0])) << claim << ": " << plan.primaries[0];
  }
}

// A pilot of 8192 knows the variance 1 with a deviation of sqrt(2 / 8192) = 1.6 %. The mean of 16
// plans lies within four of its own.
TEST(Plan, FindsDetectWithTheSuitesErrorRates) {
  const std::string test = "  - {claim: mean(single) == 2, detect: 0.3%}\n";
  const Prepared planned = plan_text(test);
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
  const auto exact = static_cast<double>(
      *stats::student_t_sample_size({.standard_deviation = 1, .rates = rates}, 0.006));
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    sum += static_cast<double>(plan_text(test, seed).plans[0].most_secondaries());
  }
  EXPECT_NEAR(sum / 16 / exact, 1, 0.016);
}

/// The upper quantile of the normal law.
double z(double p) { return stats::normal_quantile({stats::Tail::upper, std::log(p)}); }

// Two one-sided tests share the last look's beta, each with half of it: SE = margin / (z_b +
// z_b/2). The variance of ln s2 is (kurtosis - 1) / n. A pilot of 8192 has a kurtosis of 3 +- .054;
// four of these are 11 % of n, 1e-4.
TEST(Plan, OfWithinGivesBothMarginsTheirShareOfBeta) {
  const Prepared planned = plan_text("  - {claim: variance(single) within 2% of 1}\n");
  const double share = planned.plans[0].looks.beta.back();
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
    return std::pair(static_cast<double>(planned.plans[0].most_secondaries()),
                     0.02 / (z(share) + z(share / 2)));
  };
  const auto [exact, wanted] = secondaries("2");
  EXPECT_NEAR(exact * wanted * wanted, 1, 0.07);
  const auto [uncertain, of_both] = secondaries("2 +- 0.0025");
  const double left = of_both * of_both - 0.0025 * 0.0025;
  EXPECT_NEAR(uncertain * left, 1, 0.07);
  EXPECT_THAT(plan_text("  - {claim: mean(single) within 0.02 of 2 +- 0.01}\n").plans[0].error,
              testing::HasSubstr("no number of observations would decide"));
}

// Normal values, by their relative influence values of variance 2. Looks take some 8 % more than
// one, and a pilot of 8192 knows the kurtosis to 11 % of n, 1e-4.
TEST(Plan, OfVariancesHasTheSizeOfTheirInfluenceValues) {
  const Prepared planned = plan_text(
      "  - {name: one, claim: variance(single) <= 1, detect: 1%}\n"
      "  - {name: two, claim: variance(single) <= variance(single), detect: 1%}\n");
  const auto size = [&](std::size_t test, double variance) {
    const ErrorShare share = planned.place[test].share;
    const double n =
        stats::normal_sample_size(std::sqrt(variance), {.detect = std::log(1.01)},
                                  {.alpha = share.alpha, .beta = share.beta, .two_sided = false});
    return static_cast<double>(planned.plans[test].most_secondaries()) / n;
  };
  EXPECT_NEAR(size(0, 2), 1.08, .14);
  EXPECT_NEAR(size(1, 4), 1.08, .14);
}

TEST(Plan, AsksForMoreAtASmallerShare) {
  const Prepared alone = plan_text("  - {claim: mean(single) == 2, detect: 0.3%}\n");
  const Prepared among = plan_text(
      "  - {claim: mean(single) == 2, detect: 0.3%, weight: 1}\n"
      "  - {name: heavier, claim: mean(single) <= 3, weight: 99}\n");
  EXPECT_GT(among.plans[0].most_secondaries(), alone.plans[0].most_secondaries());
}

// One look decides at z = 4.9 errors of the reference, sixteen looks would take 5.1 of them.
TEST(Plan, TakesFewerLooksWhereTheReferencesErrorAllowsNoMore) {
  const Prepared planned = plan_text("  - {claim: mean(single) == 2 +- 0.001, detect: 0.005}\n");
  EXPECT_LT(planned.plans[0].most_secondaries(), 1e8);
  EXPECT_LT(planned.plans[0].looks.count(), most_looks({}));
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
    const PlannedRun planned = plan_run({load_suite(place.write("pilots.yaml", R"(suite: pilots
estimators:
  corners: {plugin: virtual_lights/weighted, primaries: 8}
  ratio: {plugin: analytic/ratio, primaries: 1024}
tests:
  - claim: )" + claim + "\n"))},
                                        {.threads = 1}, silence);
    const std::span<const double> all = planned.suites[0]->pilots.find(estimator)->values(0);
    return std::vector(all.begin(), all.end());
  };
  const std::vector<double> of_mean = values("mean(corners) == analytic", "corners");
  EXPECT_EQ(of_mean.size(), 2048);
  EXPECT_EQ(values("variance(corners) <= 100", "corners"), of_mean);
  EXPECT_EQ(values("variance(ratio) <= 100", "ratio").size(), 512);
}

TEST(Plan, PilotIsOfTheSeedAlone) {
  const std::string test = "  - {claim: mean(single) == 2}\n";
  const stats::Moments one = plan_text(test).pilots.find("single")->moments(0);
  EXPECT_EQ(plan_text(test).pilots.find("single")->moments(0), one);
  EXPECT_NE(plan_text(test, 2).pilots.find("single")->moments(0).mean, one.mean);
  EXPECT_EQ(plan_text(test).pilots.find("single")->moments(0).mean,
            plan_text(test).pilots.find("normal")->moments(0).mean)
      << "the same plugin and parameters at one primary";
}

}  // namespace
}  // namespace assay::harness
