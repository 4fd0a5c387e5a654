#include "stats/planning/power.h"

#include "stats/planning/planning.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

TEST(Power, AgreesWithR) {
  for (const tests::Row& row : tests::read_table("power")) {
    const ErrorRates rates{row["alpha"], .01, row["two_sided"] != 0};
    const std::string method = row.text("method");
    double power = -1;
    if (method == "student_t") power = student_t_power({.rates = rates}, row["n"], row["effect"]);
    if (method == "welch") {
      power =
          student_t_power({.other_standard_deviation = 1, .rates = rates}, row["n"], row["effect"]);
    }
    if (method == "chi_square_fit") {
      power = chi_square_fit_power({.degrees_of_freedom = row["m"], .rates = rates}, row["n"],
                                   row["effect"]);
    }
    // R's own noncentral t has an absolute error of 1e-12 or so.
    EXPECT_NEAR(power, row["power"], 1e-10) << method << " " << row["n"] << " " << row["effect"];
  }
}

TEST(Power, GoldenValuesToThePrintedDigits) {
  const MeanPlan one{.rates = {.01, .01, true}};
  EXPECT_NEAR(student_t_power(one, 20, .5), .29734607767526, 1e-12);
  const ErrorRates strict{1e-4, .01, true};
  // Fractional sample sizes of power.t.test(delta = .1, sig.level = 1e-4, power = .99, strict =
  // TRUE).
  EXPECT_NEAR(student_t_power({.rates = strict}, 3872.60279626629, .1), .99, 1e-9);
  EXPECT_NEAR(
      student_t_power({.other_standard_deviation = 1, .rates = strict}, 7733.85246178509, .1), .99,
      1e-9);
  // Two one-sided tests at .05. At most one misses here.
  EXPECT_NEAR(2 * student_t_power({.rates = {.05, .05, false}}, 50, .5) - 1, .934413, 5e-7);
  EXPECT_NEAR(student_t_detectable({.rates = strict}, 10000), .0622, 5e-5);
}

TEST(Power, SampleSizesAreTheSmallestThatReachTheirPower) {
  const ErrorRates rates{.01, .05, true};
  const MeanPlan mean{.standard_deviation = 2, .allow = .1, .rates = rates};
  const auto n = static_cast<double>(student_t_sample_size(mean, .5).value());
  EXPECT_GE(student_t_power(mean, n, .5), .95);
  EXPECT_LT(student_t_power(mean, n - 1, .5), .95);
  EXPECT_NEAR(n, normal_sample_size(2, {.1, .5}, rates), 6);
  const MeanPlan two{.other_standard_deviation = 3, .rates = rates};
  const auto n2 = static_cast<double>(student_t_sample_size(two, .7).value());
  EXPECT_GE(student_t_power(two, n2, .7), .95);
  EXPECT_LT(student_t_power(two, n2 - 1, .7), .95);
  const FitPlan fit{.degrees_of_freedom = 63, .allow = .02, .rates = rates};
  const auto n4 = static_cast<double>(chi_square_fit_sample_size(fit, .1).value());
  EXPECT_GE(chi_square_fit_power(fit, n4, .1), .95);
  EXPECT_LT(chi_square_fit_power(fit, n4 - 1, .1), .95);
}

// Massart's bound lies above the exact critical distance, by a share that falls like 1 / sqrt(n).
TEST(Power, DistanceSampleSizesByMassartAreEnoughAndNearlyTheSmallest) {
  for (const double detect : {.2, .05, .01}) {
    const DistancePlan plan{.rates = {.01, .05, true}};
    const auto n = static_cast<double>(ks_sample_size(plan, detect).value());
    const double root = std::sqrt(std::log(200.0) / 2) + std::sqrt(std::log(20.0) / 2);
    EXPECT_EQ(n, std::ceil(root * root / (detect * detect)));
    EXPECT_GE(ks_power_bound(plan, n, detect), .95);
    EXPECT_LT(ks_power_bound(plan, n * (1 - 1 / std::sqrt(n)), detect), .95);
  }
}

TEST(Power, DetectableEffectsReachTheirPower) {
  const ErrorRates rates{.001, .1, true};
  const MeanPlan mean{.allow = .02, .reference_standard_error = .01, .rates = rates};
  EXPECT_NEAR(student_t_power(mean, 400, student_t_detectable(mean, 400)), .9, 1e-9);
  const FitPlan fit{.degrees_of_freedom = 9, .rates = rates};
  EXPECT_NEAR(chi_square_fit_power(fit, 1000, chi_square_fit_detectable(fit, 1000)), .9, 1e-9);
  EXPECT_NEAR(ks_power_bound({.rates = rates}, 1000, ks_detectable({.rates = rates}, 1000)), .9,
              1e-9);
  EXPECT_NEAR(ks_power_bound({.two_samples = true, .rates = rates}, 1000,
                             ks_detectable({.two_samples = true, .rates = rates}, 1000)),
              .9, 1e-9);
}

TEST(Power, OfTwoSamplesIsThatOfTheOneThatVaries) {
  const MeanPlan second{.standard_deviation = 0, .other_standard_deviation = 2, .allocation = .5};
  EXPECT_DOUBLE_EQ(student_t_power(second, 80, .5),
                   student_t_power({.standard_deviation = 2}, 40, .5));
}

TEST(Power, OfUnequalSizesIsThatOfTheSamplesExchanged) {
  const ErrorRates rates{.01, .1, true};
  const DistancePlan more_of_x{.two_samples = true, .allocation = 250 / 400.0, .rates = rates};
  const DistancePlan more_of_y{.two_samples = true, .allocation = 400 / 250.0, .rates = rates};
  EXPECT_DOUBLE_EQ(ks_detectable(more_of_x, 400), ks_detectable(more_of_y, 250));
  EXPECT_LT(ks_detectable(more_of_x, 400),
            ks_detectable({.two_samples = true, .rates = rates}, 250));
  EXPECT_GT(ks_detectable(more_of_x, 400),
            ks_detectable({.two_samples = true, .rates = rates}, 400));
  // R 4.2.2: psmirnov(261/2000, c(400, 250), exact) leaves .0096 above, 260/2000 .0100035.
  EXPECT_NEAR(ks_detectable(more_of_x, 400),
              261 / 2000.0 + std::sqrt(std::log(10) / (2 * 400 * 250 / 650.0)), 1e-12);
}

// The critical distance is remembered from one question to the next, if that is the same.
TEST(Power, DetectableDistancesAreThoseOfTheirOwnPlan) {
  const ErrorRates rates{.01, .05, true};
  const DistancePlan plan{.rates = rates};
  const double one = ks_detectable(plan, 1000);
  EXPECT_GT(ks_detectable(plan, 999), one);
  EXPECT_LT(ks_detectable({.rates = {.02, .05, true}}, 1000), one);
  EXPECT_EQ(ks_detectable(plan, 1000), one);
  const double two = ks_detectable({.two_samples = true, .rates = rates}, 1000);
  EXPECT_GT(two, 1.3 * one);
  EXPECT_GT(ks_detectable({.two_samples = true, .allow = 1e-9, .rates = rates}, 1000), 1.01 * two);
}

TEST(Power, TheSmallestEffectIsWhereThePowerIsReached) {
  int asked = 0;
  const auto power = [&](double x) { return ++asked, -std::expm1(-x); };
  EXPECT_NEAR(planning::smallest_effect(power, .9, .1, .03), std::log(10), 1e-11);
  EXPECT_LT(asked, 25);
  EXPECT_EQ(planning::smallest_effect([](double) { return .5; }, .9, 0, 1), HUGE_VAL);
}

TEST(Power, AReferenceThatIsTooPoorAnswersNothing) {
  const MeanPlan plan{.reference_standard_error = .1};
  EXPECT_FALSE(student_t_sample_size(plan, .3).has_value());
  EXPECT_TRUE(student_t_sample_size(plan, .6).has_value());
}

TEST(Power, NothingToFindCostsTheLevel) {
  EXPECT_NEAR(student_t_power({.rates = {.01, .1, true}}, 30, 0), .01, 1e-12);
  EXPECT_NEAR(chi_square_fit_power({.degrees_of_freedom = 7, .rates = {.01, .1, false}}, 30, 0),
              .01, 1e-12);
}

// Far from the claim the integrals over the noncentral law are rounding noise. The power has all
// digits.
TEST(Power, OfAnEffectBeyondAllNoiseIsOne) {
  for (const double deviation : {1e-3, 1e-8, 1e-15, 1e-100}) {
    const MeanPlan plan{.standard_deviation = deviation, .rates = {.alpha = .01, .beta = .01}};
    EXPECT_EQ(student_t_power(plan, 100, .01), 1) << deviation;
    EXPECT_EQ(student_t_power(plan, 100, -.01), 1) << "two-sided, " << deviation;
    EXPECT_LT(student_t_detectable(plan, 100), deviation) << deviation;
  }
}

}  // namespace
}  // namespace assay::stats
