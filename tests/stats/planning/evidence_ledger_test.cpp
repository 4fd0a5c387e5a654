#include "stats/planning/evidence_ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <vector>

#include "tests/stats/expect_calibrated.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

using tests::expect_calibrated;
using tests::expect_caught;
using tests::Experiment;
using tests::Philox;
using tests::Row;
using tests::Shape;

// The nights of make_ratios.py: differences and standard errors.
std::vector<Evidence> known_nights(int k, int count) {
  std::vector<Evidence> nights;
  for (int i = 1; i <= count; ++i) {
    const double difference = .5 * std::cos(1.3 * i * k) + (i > 4 ? .4 * k : 0.0);
    nights.push_back(evidence_of({difference, .5 + .1 * (i % 3)}));
  }
  return nights;
}

// ln E after each night.
std::vector<double> log_e_of(const std::vector<Evidence>& nights, const LedgerPrior& prior) {
  std::vector<double> log_e;
  Evidence total;
  for (const Evidence& night : nights) log_e.push_back(log_e_value(total += night, prior));
  return log_e;
}

// ln p valid at any time: minus the largest ln E so far, at most 0.
double log_p_of(const std::vector<double>& log_e) {
  return -std::max(0.0, *std::max_element(log_e.begin(), log_e.end()));
}

TEST(EvidenceLedger, AgreesWithTheMultivariateNormalOfAllNights) {
  for (const Row& row : tests::read_table("ledger")) {
    const auto nights = known_nights(static_cast<int>(row["k"]), static_cast<int>(row["nights"]));
    const LedgerPrior prior{row["tau"], row["u"]};
    EXPECT_NEAR(log_e_of(nights, prior).back(), row["log_e"], 1e-10);
    const ChangePoint change = change_point(nights, prior);
    EXPECT_EQ(static_cast<double>(change.night), row["night"]);
    EXPECT_NEAR(change.log_likelihood_ratio, row["change"], 1e-10);
    EXPECT_NEAR(change.share[2], row["share_2"], 1e-10);
  }
}

TEST(EvidenceLedger, NothingIsKnownBeforeTheFirstNight) {
  EXPECT_EQ(log_e_value({}, {1, 0}), 0);
  EXPECT_FALSE(first_alarm({}, .01).has_value());
}

TEST(EvidenceLedger, AlarmsOnTheFirstNightThatReachesOneOverAlpha) {
  const std::vector<double> log_e{0, 2, 5, 4, 6};
  EXPECT_EQ(first_alarm(log_e, std::exp(-4.5)), 2U);
  EXPECT_EQ(first_alarm(log_e, std::exp(-5.5)), 4U);
  EXPECT_FALSE(first_alarm(log_e, std::exp(-7)).has_value());
}

TEST(EvidenceLedger, AHugeReferenceErrorMakesEveryNightWorthless) {
  const auto nights = known_nights(2, 9);
  EXPECT_NEAR(log_e_of(nights, {1, 1e6}).back(), 0, 1e-9);
}

// scipy: (1 - p + p ln p) / (p ln(p)^2) at 1e-4 and 1e-6 are 117.76 and 5239.1.
TEST(EvidenceLedger, CalibratesPValues) {
  EXPECT_NEAR(std::exp(log_e_from_log_p(std::log(1e-4))), 117.76, .005);
  EXPECT_NEAR(std::exp(log_e_from_log_p(std::log(1e-6))), 5239.1, .05);
  EXPECT_NEAR(log_e_from_log_p(0), std::log(.5), 1e-15);
  const auto closed = [](double x) { return std::log((std::exp(x) - 1 - x) / x / x); };
  for (const double x : {.5, .999999, 1.000001, 3.0}) {
    EXPECT_NEAR(log_e_from_log_p(-x), closed(x), 1e-13);
  }
  EXPECT_NEAR(log_e_from_log_p(-5000), 5000 - 2 * std::log(5000), 1e-9);
  EXPECT_THROW(log_e_from_log_p(.1), std::domain_error);
}

TEST(EvidenceLedger, CalibratedEValuesHaveMeanOne) {
  // Midpoint rule over p in (0, 1), refined towards 0 by p = t^6.
  double sum = 0;
  constexpr int steps = 200000;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + .5) / steps;
    sum += 6 * std::pow(t, 5) * std::exp(log_e_from_log_p(6 * std::log(t))) / steps;
  }
  // The integral from 0 to p is 1 / -ln p: slow, and 6 ln t reaches -75 at the first step.
  EXPECT_NEAR(sum, 1, 1 / 60.0);
}

TEST(EvidenceLedger, RefusesMalformedEvidence) {
  EXPECT_THROW(evidence_of({1, 0}), std::domain_error);
  EXPECT_THROW(evidence_of({std::nan(""), 1}), std::domain_error);
  EXPECT_THROW(log_e_value({1, 1}, {0, 0}), std::domain_error);
  EXPECT_THROW(log_e_value({1, 1}, {1, -1}), std::domain_error);
  EXPECT_THROW(log_e_value({1, -1}, {1, 0}), std::domain_error);
  EXPECT_THROW(change_point({}, {1, 0}), std::domain_error);
  EXPECT_THROW(first_alarm({}, 0), std::domain_error);
}

// Nights in units of a night's standard error. `reference` is the error of the common reference.
struct Series {
  int nights = 100;
  double bias = 0;
  double reference = 0;
  int first_biased = 0;
};

std::vector<Evidence> draw(Philox& random, const Series& series) {
  const double common = series.reference * random.normal();
  std::vector<Evidence> nights;
  for (int i = 0; i < series.nights; ++i) {
    const double bias = i >= series.first_biased ? series.bias : 0;
    nights.push_back(evidence_of({bias + common + random.normal(), 1}));
  }
  return nights;
}

const LedgerPrior habitual{.45, 0};
const LedgerPrior with_reference{.45, .2};

TEST(EvidenceLedger, KeepsItsBudgetOverAHundredNights) {
  expect_calibrated({341, 10000, Shape::at_most_uniform},
                    [](Philox& random) { return log_p_of(log_e_of(draw(random, {}), habitual)); });
  expect_calibrated({342, 10000, Shape::at_most_uniform}, [](Philox& random) {
    return log_p_of(log_e_of(draw(random, {.reference = .2}), with_reference));
  });
}

TEST(EvidenceLedger, KeepsItsBudgetWhenNightsStopEarly) {
  // Each night stops at its first half when that already looks bad.
  expect_calibrated({343, 10000, Shape::at_most_uniform}, [](Philox& random) {
    std::vector<Evidence> nights;
    for (int i = 0; i < 100; ++i) {
      Evidence night{std::sqrt(.5) * random.normal(), .5};
      if (std::abs(night.score) < 1) night += {std::sqrt(.5) * random.normal(), .5};
      nights.push_back(night);
    }
    return log_p_of(log_e_of(nights, habitual));
  });
}

TEST(EvidenceLedger, ForgettingTheErrorOfTheReferenceIsCaught) {
  expect_caught({344, 4000, Shape::at_most_uniform}, [](Philox& random) {
    return log_p_of(log_e_of(draw(random, {.reference = .2}), habitual));
  });
}

TEST(EvidenceLedger, AReferenceErrorTakenForIndependentOnEveryNightIsCaught) {
  expect_caught({345, 4000, Shape::at_most_uniform}, [](Philox& random) {
    auto nights = draw(random, {.reference = .2});
    for (Evidence& night : nights) {
      night.score /= 1.04;
      night.information /= 1.04;
    }
    return log_p_of(log_e_of(nights, habitual));
  });
}

TEST(EvidenceLedger, AnEffectFittedToTheDataIsCaught) {
  expect_caught({346, 4000, Shape::at_most_uniform}, [](Philox& random) {
    const auto nights = draw(random, {});
    std::vector<double> log_e;
    Evidence total;
    for (const Evidence& night : nights) {
      total += night;
      log_e.push_back(total.score * total.score / total.information / 2);
    }
    return log_p_of(log_e);
  });
}

// A bias of one standard error a night is found within thirty nights with probability >= .9. The
// test's budget is 3e-3. |rate - truth| <= sqrt(ln(2e5) / (2 R)) = .0391 at R = 4000, false alarm
// 1e-5.
TEST(EvidenceLedger, ABiasOfOneStandardErrorANightIsFoundWithinThirtyNights) {
  const auto found = [](std::uint32_t test_case, double reference, const LedgerPrior& prior) {
    Philox random(test_case);
    int count = 0;
    for (int i = 0; i < 4000; ++i) {
      const auto nights = draw(random, {.nights = 30, .bias = 1, .reference = reference});
      count += first_alarm(log_e_of(nights, prior), 3e-3).has_value();
    }
    return count / 4000.0;
  };
  const double exact = found(347, 0, habitual);
  const double noisy = found(348, .2, with_reference);
  std::cout << "  found: " << exact << ", with a reference error of .2: " << noisy << "\n";
  EXPECT_GE(exact, .9 + .0391);
  // A single test of all thirty nights at 3e-3 has power .77 there. Its shift is 30 / sqrt(30 + 900
  // * .04) = 3.69 against 2.97. Looking every night cannot do better.
  EXPECT_LE(noisy, .77 + .0391);
  EXPECT_GE(noisy, .25);
}

// Under the prior itself the credible nights hold the true one as often as they say. Hoeffding at
// 1e-5, R = 4000.
TEST(EvidenceLedger, CredibleNightsHoldTheNightOfTheChange) {
  Philox random(351);
  int held = 0;
  double size = 0;
  for (int i = 0; i < 4000; ++i) {
    const int first = static_cast<int>(20 * random.uniform());
    const double bias = 1.5 * random.normal();
    const auto nights =
        draw(random, {.nights = 20, .bias = bias, .reference = .2, .first_biased = first});
    const auto credible = credible_nights(change_point(nights, {1.5, .2}), .9);
    held += std::binary_search(credible.begin(), credible.end(), static_cast<std::size_t>(first));
    size += static_cast<double>(credible.size());
  }
  std::cout << "  held " << held / 4000.0 << ", mean size " << size / 4000 << "\n";
  EXPECT_GE(held / 4000.0, .9 - .0391);
}

}  // namespace
}  // namespace assay::stats
