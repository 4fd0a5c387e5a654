#include "stats/images/image_reference_error.h"

#include "tests/prelude.h"
#include "tests/stats/calibration.h"
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
  // The side of the test.
  bool lower = true;
};

// The margin's p-values with the bias at the margin and the reference as uncertain as the images.
// `judge` makes the distance.
template <class Judge>
Calibration at_margin(std::uint32_t test_case, const Case& given, const Judge& judge) {
  return calibrate({test_case, 2000, Shape::at_most_uniform}, [&](Philox& random) {
    const OwnedStack a = draw_stack(extent, images, [&](std::size_t) {
      return 10 * (1 + margin) + given.sd * random.normal();
    });
    const double error = given.sd / std::sqrt(static_cast<double>(images));
    const double common = random.normal();
    std::vector<double> value(extent.elements());
    for (double& v : value) v = 10 + error * (given.common ? common : random.normal());
    const std::vector<double> errors(extent.elements(), error);
    const ImageDistance distance = judge(a.view(), ImageReference{extent, value, errors});
    const TestResult result = squared_margin_test(distance, margin * margin);
    return below_half(given.lower ? result.log_p_lower : result.log_p_upper);
  });
}

const auto independent = [](const auto& a, const ImageReference& b) {
  return with_reference_error(image_distance(a, b), a, b, ElementErrors::independent);
};
const auto unknown = [](const auto& a, const ImageReference& b) {
  return with_reference_error(image_distance(a, b), a, b, ElementErrors::unknown);
};
const auto left_out = [](const auto& a, const ImageReference& b) { return image_distance(a, b); };

// Every calibration raises a false alarm with probability 1e-5.
TEST(ImageReferenceError, KeepsTheLevelAtTheMargin) {
  std::uint32_t test_case = 1200;
  for (const double sd : {1.0, 8.0}) {
    for (const bool lower : {true, false}) {
      const Calibration calibration =
          at_margin(test_case++, {.sd = sd, .lower = lower}, independent);
      EXPECT_TRUE(calibration.ok) << sd << lower << ": " << calibration.text();
    }
  }
}

TEST(ImageReferenceError, KeepsTheLevelWhateverTheDependence) {
  for (const bool lower : {true, false}) {
    const Case given{.sd = 1, .common = true, .lower = lower};
    const Calibration calibration = at_margin(lower ? 1210 : 1211, given, unknown);
    EXPECT_TRUE(calibration.ok) << lower << ": " << calibration.text();
  }
}

TEST(ImageReferenceError, LeftOutIsCaught) {
  for (const bool lower : {true, false}) {
    EXPECT_FALSE(at_margin(lower ? 1220 : 1221, {.sd = 1, .lower = lower}, left_out).ok) << lower;
  }
}

TEST(ImageReferenceError, TakenForIndependentWhereItIsCommonIsCaught) {
  EXPECT_FALSE(at_margin(1230, {.sd = 1, .common = true}, independent).ok);
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
