#include "stats/images/image_reference_error.h"

#include "tests/prelude.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

constexpr ImageExtent extent{12, 12, 1};
constexpr double margin = 0.1;
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
  const ImageStack<float> a = stack.view();
  ImageDistance distance = image_distance(a, reference);
  if (given.taken) distance = with_reference_error(distance, a, reference, *given.taken);
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
  const ImageDistance before = image_distance(a.view(), exact);
  const ImageDistance after = with_reference_error(before, a.view(), exact, ElementErrors::unknown);
  EXPECT_EQ(after.bias_variance, before.bias_variance);
  EXPECT_EQ(after.norm_variance, before.norm_variance);
  EXPECT_EQ(after.covariance, before.covariance);
}

}  // namespace
}  // namespace assay::stats
