#include "stats/planning/evidence_ledger.h"

#include "stats/basics/moments.h"
#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// The nights of make_ratios.py: differences, standard errors and observations.
std::vector<NightEstimate> known_nights(int k, int count) {
  std::vector<NightEstimate> nights;
  for (int i = 1; i <= count; ++i) {
    const double difference = .5 * std::cos(1.3 * i * k) + (i > 14 ? .2 * k : 0.0);
    nights.push_back({difference, .5 + .1 * (i % 3), 100.0 + 50 * (i % 2), 30});
  }
  return nights;
}

// ln E after each night.
std::vector<double> log_e_of(const std::vector<NightEstimate>& nights, double reference_error = 0) {
  std::vector<double> log_e;
  PooledNights pooled;
  for (const NightEstimate& night : nights) {
    pooled.add(night);
    log_e.push_back(log_e_value(pooled, {.reference_error = reference_error}));
  }
  return log_e;
}

std::vector<double> log_e_of_p_values(const std::vector<double>& log_p) {
  std::vector<double> log_e;
  PooledPValues pooled;
  for (const double each : log_p) {
    pooled.add(each);
    log_e.push_back(log_e_value(pooled));
  }
  return log_e;
}

// ln p valid at any time: minus the largest ln E so far, at most 0.
double log_p_of(const std::vector<double>& log_e) {
  return -std::max(0.0, *std::max_element(log_e.begin(), log_e.end()));
}

TEST(EvidenceLedger, AgreesWithQuadratureOverThetaAndTheReference) {
  for (const Row& row : tests::read_table("ledger")) {
    const auto nights = known_nights(static_cast<int>(row["k"]), static_cast<int>(row["nights"]));
    EXPECT_NEAR(log_e_of(nights, row["u"]).back(), row["log_e"], 1e-9);
    const ChangePoint change = change_point(nights, {.reference_error = row["u"]});
    EXPECT_EQ(static_cast<double>(change.night), row["night"]);
    EXPECT_NEAR(change.log_likelihood_ratio, row["change"], 1e-9);
    EXPECT_NEAR(change.share[2], row["share_2"], 1e-9);
  }
}

TEST(EvidenceLedger, PValuesAgreeWithQuadratureOverTheirExponent) {
  for (const Row& row : tests::read_table("ledger_p")) {
    const PooledPValues pooled{.nights = static_cast<std::size_t>(row["nights"]),
                               .minus_log_p = row["minus_log_p"]};
    EXPECT_NEAR(log_e_value(pooled), row["log_e"], 1e-10 * std::max(1.0, std::abs(row["log_e"])));
  }
}

TEST(EvidenceLedger, NothingIsKnownBeforeTheFirstNight) {
  EXPECT_EQ(log_e_value(PooledNights(), {}), 0);
  EXPECT_EQ(log_e_value(PooledPValues()), 0);
  EXPECT_FALSE(first_alarm({}, .01).has_value());
}

TEST(EvidenceLedger, IsSilentUntilFiftyObservationsVary) {
  const auto path = log_e_of(std::vector<NightEstimate>(50, {5, 1, 100, 1}));
  EXPECT_EQ(path[48], 0);
  EXPECT_GT(path[49], 100);
  EXPECT_EQ(log_e_of({{5, 1, 100, 49.9}})[0], 0);
  EXPECT_GT(log_e_of({{5, 1, 100, 50}})[0], 0);
  // One night of three times the error outweighs the others.
  std::vector<NightEstimate> uneven(50, {5, 1, 100, 1});
  uneven[3].standard_error = 3;
  EXPECT_EQ(log_e_of(uneven).back(), 0);
}

// A night without spread has its place in the mean, but no error of its own.
TEST(EvidenceLedger, ANightWithoutSpreadCountsByItsObservations) {
  PooledNights pooled;
  pooled.add({-1, 0, 300});
  pooled.add({3, 2, 100});
  EXPECT_DOUBLE_EQ(pooled.difference(), 0);
  EXPECT_DOUBLE_EQ(pooled.variance(), .25);
}

TEST(EvidenceLedger, AlarmsOnTheFirstNightThatReachesOneOverAlpha) {
  const std::vector<double> log_e{0, 2, 5, 4, 6};
  EXPECT_EQ(first_alarm(log_e, std::exp(-4.5)), 2U);
  EXPECT_EQ(first_alarm(log_e, std::exp(-5.5)), 4U);
  EXPECT_FALSE(first_alarm(log_e, std::exp(-7)).has_value());
}

TEST(EvidenceLedger, AHugeReferenceErrorMakesEveryNightWorthless) {
  EXPECT_NEAR(log_e_of(known_nights(2, 60), 1e6).back(), 0, 1e-9);
}

// Nights in units of a night's standard error. `reference` is the error of the common reference.
struct Series {
  int nights = 100;
  double bias = 0, reference = 0;
  int first_biased = 0;
};

std::vector<NightEstimate> draw(Philox& random, const Series& series) {
  const double common = series.reference * random.normal();
  std::vector<NightEstimate> nights;
  for (int i = 0; i < series.nights; ++i) {
    const double bias = i >= series.first_biased ? series.bias : 0;
    nights.push_back({bias + common + random.normal(), 1, 100, 33});
  }
  return nights;
}

CALIBRATED(EvidenceLedger, KeepsItsBudgetOverAThousandNights, 341, 10000, Shape::at_most_uniform) {
  return log_p_of(log_e_of(draw(random, {.nights = 1000})));
}

CALIBRATED(EvidenceLedger, KeepsItsBudgetBesideAReference, 342, 10000, Shape::at_most_uniform) {
  return log_p_of(log_e_of(draw(random, {.nights = 1000, .reference = .2}), .2));
}

// Each night stops at its first half when that already looks bad.
CALIBRATED(EvidenceLedger, KeepsItsBudgetWhenNightsStopEarly, 343, 10000, Shape::at_most_uniform) {
  std::vector<NightEstimate> nights;
  for (int i = 0; i < 100; ++i) {
    const double half = random.normal() * std::sqrt(2);
    const double whole = half / 2 + random.normal() / std::sqrt(2);
    nights.push_back(std::abs(half) > 1 ? NightEstimate{half, std::sqrt(2), 50, 16}
                                        : NightEstimate{whole, 1, 100, 33});
  }
  return log_p_of(log_e_of(nights));
}

// Observations are 1 with this probability, else 0, and the night is what its sample says.
NightEstimate night_of_hits(Philox& random, double probability, int count) {
  int hits = 0;
  for (int i = 0; i < count; ++i) hits += random.uniform() < probability;
  const double share = hits / double(count);
  const double variance = share * (1 - share);
  const double effective = hits == 0 ? 1 : std::max(1.0, count * variance / (1 - 3 * variance));
  return {share - probability, std::sqrt(variance / (count - 1)), double(count), effective};
}

// Half of the nights have no hit at all, and no spread.
std::vector<NightEstimate> rare_hits(Philox& random, int nights) {
  std::vector<NightEstimate> all;
  for (int i = 0; i < nights; ++i) all.push_back(night_of_hits(random, .02, 40));
  return all;
}

CALIBRATED(EvidenceLedger, KeepsItsBudgetForRareHits, 352, 4000, Shape::at_most_uniform) {
  return log_p_of(log_e_of(rare_hits(random, 200)));
}

CAUGHT(EvidenceLedger, NightsOfFewHitsThatSpeakAtOnceAreCaught, 363, 4000, Shape::at_most_uniform) {
  auto nights = rare_hits(random, 200);
  for (NightEstimate& night : nights) night.effective = 50;
  return log_p_of(log_e_of(nights));
}

CAUGHT(EvidenceLedger, LeavingOutNightsWithoutAHitIsCaught, 353, 1000, Shape::at_most_uniform) {
  auto nights = rare_hits(random, 200);
  std::erase_if(nights, [](const NightEstimate& night) { return night.standard_error == 0; });
  return log_p_of(log_e_of(nights));
}

// Values of exponential law.
std::vector<NightEstimate> skewed(Philox& random, int nights) {
  std::vector<NightEstimate> all;
  for (int i = 0; i < nights; ++i) {
    Moments moments;
    for (int j = 0; j < 50; ++j) moments.add(-std::log(random.uniform()));
    all.push_back({moments.mean - 1, moments.standard_error(), 50, 50 / moments.kurtosis()});
  }
  return all;
}

CALIBRATED(EvidenceLedger, KeepsItsBudgetForSkewedValues, 354, tests::repetitions(4000),
           Shape::at_most_uniform) {
  return log_p_of(log_e_of(skewed(random, 200)));
}

CAUGHT(EvidenceLedger, WeightsByTheNightsOwnErrorsAreCaught, 355, 2000, Shape::at_most_uniform) {
  auto nights = skewed(random, 200);
  for (NightEstimate& night : nights) {
    night.observations = 1 / (night.standard_error * night.standard_error);
  }
  return log_p_of(log_e_of(nights));
}

CAUGHT(EvidenceLedger, AReferenceErrorTakenForIndependentOnEveryNightIsCaught, 345, 4000,
       Shape::at_most_uniform) {
  auto nights = draw(random, {.reference = .2});
  for (NightEstimate& night : nights) night.standard_error = std::sqrt(1.04);
  return log_p_of(log_e_of(nights));
}

std::vector<double> log_p_values(Philox& random, int nights) {
  std::vector<double> log_p;
  for (int i = 0; i < nights; ++i) log_p.push_back(std::log(random.uniform()));
  return log_p;
}

CALIBRATED(EvidenceLedger, PValuesKeepTheirBudgetOverAThousandNights, 356, 10000,
           Shape::at_most_uniform) {
  return log_p_of(log_e_of_p_values(log_p_values(random, 1000)));
}

// One-sided p-values that are half as large as they should be.
CAUGHT(EvidenceLedger, PValuesOfTheWrongTailAreCaught, 357, 2000, Shape::at_most_uniform) {
  auto log_p = log_p_values(random, 200);
  for (double& each : log_p) each -= std::log(2);
  return log_p_of(log_e_of_p_values(log_p));
}

// The share of 4000 series that alarm at this budget. |rate - truth| <= sqrt(ln(2e5) / (2 R)) =
// .0391 at R = 4000, false alarm 1e-5.
double alarmed(std::uint32_t test_case, double alpha,
               const std::function<std::vector<double>(Philox&)>& log_e) {
  Philox random(test_case);
  int count = 0;
  for (int i = 0; i < 4000; ++i) count += first_alarm(log_e(random), alpha).has_value();
  return count / 4000.0;
}

// A bias of one standard error a night is found within thirty nights with probability >= .9. The
// test's budget is 3e-3.
TEST(EvidenceLedger, ABiasOfOneStandardErrorANightIsFoundWithinThirtyNights) {
  const double exact = alarmed(
      347, 3e-3, [](Philox& random) { return log_e_of(draw(random, {.nights = 30, .bias = 1})); });
  const double noisy = alarmed(348, 3e-3, [](Philox& random) {
    return log_e_of(draw(random, {.nights = 30, .bias = 1, .reference = .2}), .2);
  });
  EXPECT_GE(exact, .9 + .0391);
  // A single test of all thirty nights at 3e-3 has power .77 there. Its shift is 30 / sqrt(30 + 900
  // * .04) = 3.69 against 2.97. Looking every night cannot do better.
  EXPECT_LE(noisy, .77 + .0391);
  EXPECT_GE(noisy, .25);
}

// Z is 11 over 55 nights, by estimates or by two-sided p-values, after so many quiet nights.
struct Found {
  double estimates = 0, p_values = 0;
};
Found eleven_standard_errors(std::uint32_t test_case, int quiet) {
  const Series series{.nights = quiet + 55, .bias = 11 / std::sqrt(55), .first_biased = quiet};
  return {.estimates = alarmed(test_case, 3e-3,
                               [&](Philox& random) { return log_e_of(draw(random, series)); }),
          .p_values = alarmed(test_case + 1, 3e-3, [&](Philox& random) {
            std::vector<double> log_p;
            for (const NightEstimate& night : draw(random, series)) {
              log_p.push_back(log_p_two_sided(normal_tails(night.difference)));
            }
            return log_e_of_p_values(log_p);
          })};
}

TEST(EvidenceLedger, ElevenStandardErrorsOverFiftyFiveNightsAreFound) {
  const Found at_once = eleven_standard_errors(359, 0);
  EXPECT_GE(at_once.estimates, .99);
  EXPECT_GE(at_once.p_values, .99);
  const Found late = eleven_standard_errors(361, 200);
  EXPECT_GE(late.estimates, .8);
  EXPECT_GE(late.p_values, .6);
}

// Under the prior itself the credible nights hold the true one as often as they say. Hoeffding at
// 1e-5, R = 4000.
TEST(EvidenceLedger, CredibleNightsHoldTheNightOfTheChange) {
  Philox random(351);
  int held = 0;
  for (int i = 0; i < 4000; ++i) {
    const int first = static_cast<int>(20 * random.uniform());
    const double bias = std::sqrt(.2) * random.normal();
    const auto nights =
        draw(random, {.nights = 20, .bias = bias, .reference = .2, .first_biased = first});
    const auto credible = credible_nights(change_point(nights, {.reference_error = .2}), .9);
    held += std::binary_search(credible.begin(), credible.end(), static_cast<std::size_t>(first));
  }
  EXPECT_GE(held / 4000.0, .9 - .0391);
}

}  // namespace
}  // namespace assay::stats
