#include "stats/images/image_sign_flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/stats/calibration.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

using tests::calibrate;
using tests::draw_stack;
using tests::Experiment;
using tests::OwnedStack;
using tests::Philox;
using tests::Shape;

constexpr ImageExtent extent{8, 6, 1};

// Exponential values smoothed along rows: skewed and correlated. `shift` is added to all.
OwnedStack correlated_stack(Philox& random, std::size_t replicates, double shift = 0) {
  double last = 0;
  return draw_stack(extent, replicates, [&](std::size_t) {
    last = 0.7 * last + random.exponential();
    return last + shift;
  });
}

FlipMatrix null_matrix(Philox& random, std::size_t replicates = 16) {
  const OwnedStack a = correlated_stack(random, replicates);
  return flip_matrix(a.view(), correlated_stack(random, replicates).view());
}

TEST(ImageSignFlip, EnergiesSideBySideAreThoseOfEachVectorAlone) {
  constexpr std::size_t replicates = 17;
  Philox random(852);
  const FlipMatrix matrix = null_matrix(random, replicates);
  std::vector<double> signs(replicates * FlipMatrix::together);
  for (double& sign : signs) sign = random.uniform() < 0.5 ? -1 : 1;
  const auto energies = matrix.energies(signs);
  for (std::size_t k = 0; k < FlipMatrix::together; ++k) {
    std::vector<double> alone;
    for (std::size_t r = 0; r < replicates; ++r) {
      alone.push_back(signs[r * FlipMatrix::together + k]);
    }
    EXPECT_EQ(energies[k], matrix.energy(alone));
  }
}

// Both calibrations: false alarm 1e-5.
TEST(ImageSignFlip, EnumerationKeepsItsLevelOnCorrelatedSkewedImages) {
  const auto calibration = calibrate({850, 400, Shape::at_most_uniform}, [](Philox& random) {
    return sign_flip(null_matrix(random), 0.01).log_p;
  });
  EXPECT_TRUE(calibration.ok) << calibration.text();
}

TEST(ImageSignFlip, MonteCarloKeepsItsLevelOnCorrelatedSkewedImages) {
  const auto calibration = calibrate({851, 4000, Shape::at_most_uniform}, [](Philox& random) {
    const FlipMatrix matrix = null_matrix(random);
    return sign_flip(matrix, {.share = 0.1, .flips = 19, .enough = 20}, random).log_p;
  });
  EXPECT_TRUE(calibration.ok) << calibration.text();
}

TEST(ImageSignFlip, NotCountingTheObservedSignsIsCaught) {
  const auto calibration = calibrate({851, 4000, Shape::at_most_uniform}, [](Philox& random) {
    const FlipMatrix matrix = null_matrix(random);
    const double p =
        std::exp(sign_flip(matrix, {.share = 0.1, .flips = 19, .enough = 20}, random).log_p);
    return std::log(std::max(20 * p - 1, 1e-12) / 19);
  });
  EXPECT_FALSE(calibration.ok) << calibration.text();
}

// p-values of flips that end with the third vector to reach Q, or after 39.
template <class Change>
tests::Calibration calibrated_early_stop(Change change) {
  return calibrate({857, 4000, Shape::at_most_uniform}, [&](Philox& random) {
    return change(sign_flip(null_matrix(random), {.share = 0.1, .flips = 39, .enough = 3}, random));
  });
}

TEST(ImageSignFlip, EndingWhenEnoughHaveReachedKeepsTheLevel) {
  const auto calibration = calibrated_early_stop([](const SignFlip& flip) { return flip.log_p; });
  EXPECT_TRUE(calibration.ok) << calibration.text();
}

// The mutant takes the share of the vectors drawn, as if their number had been fixed.
TEST(ImageSignFlip, CountingWhatReachedBeforeTheLastIsCaught) {
  const auto calibration = calibrated_early_stop([](const SignFlip& flip) {
    return flip.flips < 39 ? flip.log_p + std::log(2.0 / 3) : flip.log_p;
  });
  EXPECT_FALSE(calibration.ok) << calibration.text();
}

// One vector fewer, and they are not yet enough: the same share of ranks.
TEST(ImageSignFlip, EndsWithTheVectorThatMakesThemEnough) {
  Philox random(858);
  const FlipMatrix matrix = null_matrix(random);
  Philox again = random;
  const SignFlip early = sign_flip(matrix, {.share = 0.1, .flips = 5000, .enough = 50}, random);
  ASSERT_LT(early.flips, 5000);
  EXPECT_DOUBLE_EQ(early.log_p, std::log(50 / static_cast<double>(early.flips)));
  const SignFlip all =
      sign_flip(matrix, {.share = 0.1, .flips = early.flips - 1, .enough = 50}, again);
  EXPECT_EQ(all.flips, early.flips - 1);
  EXPECT_DOUBLE_EQ(all.log_p, early.log_p);
}

TEST(ImageSignFlip, FlippingElementsByThemselvesIsCaught) {
  const auto calibration = calibrate({852, 2000, Shape::at_most_uniform}, [](Philox& random) {
    OwnedStack a = correlated_stack(random, 16);
    const OwnedStack b = correlated_stack(random, 16);
    const auto energy = [&] {
      return flip_matrix(a.view(), b.view()).energy(std::vector<double>(16, 1));
    };
    for (auto& image : a.images) {
      const double common = random.normal();
      for (float& value : image) value += static_cast<float>(common);
    }
    const double observed = energy();
    double reached = 1;
    for (int flip = 0; flip < 19; ++flip) {
      for (std::size_t r = 0; r < 16; ++r) {
        for (std::size_t e = 0; e < extent.elements(); ++e) {
          if (random.uniform() < 0.5) a.images[r][e] = 2 * b.images[r][e] - a.images[r][e];
        }
      }
      reached += energy() >= observed;
    }
    return std::log(reached / 20);
  });
  EXPECT_FALSE(calibration.ok) << calibration.text();
}

TEST(ImageSignFlip, ABiasIsFoundAtTheSmallestPossiblePValue) {
  Philox random(853);
  const OwnedStack a = correlated_stack(random, 20, 10);
  const FlipMatrix matrix = flip_matrix(a.view(), correlated_stack(random, 20).view());
  const SignFlip flip = sign_flip(matrix, 1e-4);
  EXPECT_NEAR(flip.log_p, -19 * std::log(2), 1e-12);
  EXPECT_EQ(flip.exactness, Exactness::asymptotic);
  const SignFlip drawn = sign_flip(matrix, {.share = 1e-3, .flips = 5000, .enough = 100}, random);
  EXPECT_EQ(drawn.method, FlipMethod::monte_carlo);
  EXPECT_NEAR(drawn.log_p, -std::log(5001), 1e-12);
}

TEST(ImageSignFlip, MonteCarloConvergesToEnumeration) {
  Philox random(854);
  const FlipMatrix matrix = null_matrix(random);
  const double exact = std::exp(sign_flip(matrix, 0.01).log_p);
  const double drawn =
      std::exp(sign_flip(matrix, {.share = 0.01, .flips = 20000, .enough = 20000}, random).log_p);
  EXPECT_NEAR(drawn, exact, 4.5 * std::sqrt(0.25 / 20000));  // false alarm below 1e-5
}

TEST(ImageSignFlip, TooFewReplicatesOrFlipsAreRefusedWithTheReason) {
  Philox random(855);
  const FlipMatrix matrix = null_matrix(random);
  EXPECT_NO_THROW(sign_flip(matrix, std::exp2(-14)));
  try {
    sign_flip(matrix, std::exp2(-14.5));
    FAIL();
  } catch (const std::domain_error& error) {
    EXPECT_NE(std::string(error.what()).find("2^(1 - replicates)"), std::string::npos);
  }
  EXPECT_THROW(sign_flip(matrix, {.share = 0.01, .flips = 198, .enough = 9}, random),
               std::domain_error);
  EXPECT_NO_THROW(sign_flip(matrix, {.share = 0.01, .flips = 199, .enough = 9}, random));
  EXPECT_THROW(sign_flip(matrix, {.share = 0.01, .flips = 199, .enough = 0}, random),
               std::domain_error);
  EXPECT_THROW(sign_flip(matrix, 0.0), std::domain_error);
  EXPECT_THROW(sign_flip(null_matrix(random, 26), 0.01), std::domain_error);
  const OwnedStack a = correlated_stack(random, 16);
  EXPECT_THROW(flip_matrix(a.view(), correlated_stack(random, 17).view()), std::domain_error);
  const std::vector<double> value(extent.elements());
  EXPECT_THROW(flip_matrix(a.view(), ImageReference{extent, value, value}), std::domain_error);
}

TEST(ImageSignFlip, AReferenceIsTheSameInEveryReplicate) {
  Philox random(856);
  const OwnedStack a = correlated_stack(random, 16);
  OwnedStack b{extent, {}};
  b.images.assign(16, std::vector<float>(extent.elements(), 3));
  const std::vector<double> value(extent.elements(), 3);
  EXPECT_DOUBLE_EQ(sign_flip(flip_matrix(a.view(), b.view()), 0.01).statistic,
                   sign_flip(flip_matrix(a.view(), ImageReference{extent, value}), 0.01).statistic);
}

}  // namespace
}  // namespace assay::stats
