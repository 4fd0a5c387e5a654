#include "stats/images/image_equivalence.h"

#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

constexpr ImageExtent extent{12, 12, 1};
constexpr double margin = 0.1;

// Brightness 10 everywhere, a factor (1 + bias) brighter.
OwnedStack image(Philox& random, double bias, double sd = 1) {
  return draw_stack(extent, 32,
                    [&](std::size_t) { return 10 * (1 + bias) + sd * random.normal(); });
}

// The test of ||E a - E b|| >= margin ||E b||.
template <class Second>
TestResult within(const OwnedStack& a, const Second& b) {
  return squared_margin_test(image_distance({a.view(), b}), margin * margin);
}

TEST(ImageEquivalence, AtTheMarginBothSidesKeepTheirLevel) {
  for (const double sd : {1.0, 8.0}) {
    expect_tails_calibrated({860, 2000, Shape::at_most_uniform}, [&](Philox& random) {
      const OwnedStack a = image(random, margin, sd);
      return below_half(within(a, image(random, 0, sd).view()));
    });
  }
}

// The mutant does not subtract the noise of the means.
CAUGHT(ImageEquivalence, ASquaredDifferenceThatKeepsTheNoiseIsCaught, 861, 2000,
       Shape::at_most_uniform) {
  const OwnedStack a = image(random, margin, 8);
  const OwnedStack b = image(random, 0, 8);
  const ImageDistance distance = image_distance({a.view(), b.view()});
  const double noise = 2 * 64.0 / 32 * static_cast<double>(extent.elements());
  const double norm = 100 * static_cast<double>(extent.elements());
  const double t =
      (distance.squared_bias + noise - margin * margin * norm) / std::sqrt(distance.bias_variance);
  return below_half(student_t_tails(t, distance.degrees).upper);
}

// The mutant takes the variance of the leave-one-out values for that of the estimate.
CAUGHT(ImageEquivalence, AJackknifeWithoutItsFactorIsCaught, 862, 2000, Shape::at_most_uniform) {
  const OwnedStack a = image(random, margin, 8);
  const TestResult result = within(a, image(random, 0, 8).view());
  return below_half(student_t_tails(result.statistic * std::sqrt(31.0), 31).lower);
}

TEST(ImageEquivalence, TheSquaredBiasIsUnbiased) {
  Philox random(863);
  for (const double bias : {0.0, 0.05}) {
    Moments squared;
    for (int i = 0; i < 400; ++i) {
      const OwnedStack a = image(random, bias, 4);
      squared.add(image_distance({a.view(), image(random, 0, 2).view()}).squared_bias);
    }
    const double truth = 100 * bias * bias * static_cast<double>(extent.elements());
    // False alarm below 1e-5.
    EXPECT_NEAR(squared.mean, truth, 4.5 * squared.standard_error()) << bias;
  }
}

TEST(ImageEquivalence, EqualImagesAreEquivalentAndADifferentOneIsNot) {
  Philox random(865);
  const OwnedStack a = image(random, 0);
  const OwnedStack b = image(random, 0);
  const OwnedStack c = image(random, 0.2);
  EXPECT_LT(within(a, b.view()).log_p_lower, std::log(1e-6));
  EXPECT_GT(within(c, b.view()).log_p_lower, std::log(0.99));
  const std::vector<double> truth(extent.elements(), 10);
  const ImageReference reference{extent, truth};
  EXPECT_LT(within(a, reference).log_p_lower, std::log(1e-6));
  EXPECT_NEAR(image_distance({c.view(), reference}).squared_bias, 4 * 144, 30);
}

// Beside a family of places the distance has its share of alpha, and no more.
TEST(ImageEquivalence, TheUpperPValueIsOverTheShare) {
  Philox random(866);
  const ImageDistance distance =
      image_distance({image(random, 0.03).view(), image(random, 0).view()});
  const auto log_p = [&](double share, double theta) {
    return theta_test({.of_elements = distance, .share = share}, theta).log_p_upper;
  };
  for (const double theta : {0.0, 1e-4}) {
    ASSERT_LT(log_p(0, theta), std::log(.25));
    EXPECT_NEAR(log_p(.25, theta), log_p(0, theta) + std::log(4), 1e-12);
  }
  EXPECT_EQ(log_p(1e-300, 0), 0);
}

// More elements than are taken at a time.
TEST(ImageEquivalence, TheDistanceIsTheSameInAnyOrderAndOfAllElements) {
  Philox random(878);
  const ImageExtent large{300, 200, 1};
  const auto draw = [&](double mean) {
    return tests::draw_stack(large, 16, [&](std::size_t) { return mean + 0.1 * random.normal(); });
  };
  const OwnedStack a = draw(1.05);
  const OwnedStack b = draw(1);
  const ImageDistance distance = image_distance({a.view(), b.view()});
  const ImageDistance other = image_distance({a.view(), b.view()}, tests::last_first);
  EXPECT_EQ(distance.squared_bias, other.squared_bias);
  EXPECT_EQ(distance.bias_variance, other.bias_variance);
  EXPECT_EQ(distance.covariance, other.covariance);
  EXPECT_NEAR(distance.squared_norm, 60000, 60);
  EXPECT_NEAR(distance.squared_bias, 60000 * 0.05 * 0.05, 4);
  // 4 (bias^2 + v) v for each element, v = (va + vb) / R, with 30 degrees of freedom.
  const double v = 0.02 / 16;
  EXPECT_NEAR(distance.bias_variance / (60000 * 4 * (0.05 * 0.05 + v) * v), 1, 0.8);
}

// With a norm of 1 for each element the margin is a root mean square.
TEST(ImageEquivalence, ANormWithoutErrorLeavesTheBiasAlone) {
  Philox random(871);
  const OwnedStack a = image(random, 0.05, 1);
  const OwnedStack b = image(random, 0, 1);
  const ImageDistance plain =
      relative_to(image_distance({a.view(), b.view()}), {.squared_bias = 144});
  EXPECT_EQ(plain.norm_variance, 0);
  const TestResult at = squared_margin_test(plain, plain.squared_bias / 144);
  EXPECT_NEAR(at.statistic, 0, 1e-9);
  EXPECT_LT(squared_margin_test(plain, 0.3 * 0.3).log_p_upper, std::log(0.01));
}

constexpr std::size_t images = 32;

struct Case {
  // For an image's element. The reference's error is that of a mean of 32 images.
  double sd = 1;
  // One error of all elements of the reference.
  bool common = false;
  // How its error is taken into account, if it is.
  std::optional<ElementErrors> taken = ElementErrors::independent;
};

// The margin's p-values with the bias at the margin and the reference as uncertain as the images.
TestResult at_margin(Philox& random, const Case& given) {
  const OwnedStack stack = draw_stack(
      extent, images, [&](std::size_t) { return 10 * (1 + margin) + given.sd * random.normal(); });
  const double error = given.sd / std::sqrt(static_cast<double>(images));
  const double common = random.normal();
  std::vector<double> value(extent.elements());
  for (double& v : value) v = 10 + error * (given.common ? common : random.normal());
  const std::vector<double> errors(extent.elements(), error);
  const ImageReference reference{extent, value, errors};
  const ImageStack a = stack.view();
  ImageDistance distance = image_distance({a, reference});
  if (given.taken) distance = with_reference_error(distance, {a, reference}, *given.taken);
  return below_half(squared_margin_test(distance, margin * margin));
}

TEST(ImageReferenceError, KeepsTheLevelAtTheMargin) {
  for (const double sd : {1.0, 8.0}) {
    expect_tails_calibrated({1200, 2000, Shape::at_most_uniform},
                            [&](Philox& random) { return at_margin(random, {.sd = sd}); });
  }
}

TAILS_CALIBRATED(ImageReferenceError, KeepsTheLevelWhateverTheDependence, 1210, 2000,
                 Shape::at_most_uniform) {
  return at_margin(random, {.common = true, .taken = ElementErrors::unknown});
}

CAUGHT(ImageReferenceError, LeftOutIsCaught, 1220, 2000, Shape::at_most_uniform) {
  return at_margin(random, {.taken = {}}).log_p_lower;
}

CAUGHT(ImageReferenceError, LeftOutIsCaughtOnTheOtherSide, 1221, 2000, Shape::at_most_uniform) {
  return at_margin(random, {.taken = {}}).log_p_upper;
}

CAUGHT(ImageReferenceError, TakenForIndependentWhereItIsCommonIsCaught, 1230, 2000,
       Shape::at_most_uniform) {
  return at_margin(random, {.common = true}).log_p_lower;
}

TEST(ImageReferenceError, OfAnExactReferenceIsNothing) {
  Philox random(1240);
  const OwnedStack a = draw_stack(extent, images, [&](std::size_t) { return random.normal(); });
  const std::vector<double> value(extent.elements(), 1);
  const ImageReference exact{extent, value, {}};
  const ImageDistance before = image_distance({a.view(), exact});
  const ImageDistance after =
      with_reference_error(before, {a.view(), exact}, ElementErrors::unknown);
  EXPECT_EQ(after.bias_variance, before.bias_variance);
  EXPECT_EQ(after.norm_variance, before.norm_variance);
  EXPECT_EQ(after.covariance, before.covariance);
}

}  // namespace
}  // namespace assay::stats
