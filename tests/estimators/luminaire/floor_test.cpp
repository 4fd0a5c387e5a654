#include "tests/estimators/prelude.h"
// Images of a plane's irradiance: every pixel is a luminaire estimator of its own.

namespace assay {
namespace {

constexpr const char* small = "{width: 6, height: 4, size: 3}";

TEST(Floor, DeclaresItsShapeAndNamesItsPixels) {
  const auto floor = prepare("luminaire/floor", small);
  const ImageShape shape = floor.setup->image().value();
  EXPECT_EQ(shape.width, 6u);
  EXPECT_EQ(shape.height, 4u);
  EXPECT_EQ(shape.components, std::vector<std::string>{"irradiance"});
  EXPECT_TRUE(shape.independent);
  const std::vector<Channel> channels = floor.setup->channels();
  ASSERT_EQ(channels.size(), 24u);
  EXPECT_EQ(channels[0].name, "x0y0");
  EXPECT_EQ(channels[2 * 6 + 5].name, "x5y2");
}

// The receiver in the middle of an image of odd size is the scene's, whose irradiance is known.
TEST(Floor, TheMiddlePixelIsTheScenesReceiver) {
  const auto floor = prepare("luminaire/floor", "{width: 3, height: 3}");
  EXPECT_NEAR(floor.channel(4).mean.value(), 0.481046907316, 1e-11);
}

// A receiver moved by hand: pixel x5y2 of 6 x 4 squares of 0.5.
TEST(Floor, EveryPixelHasLambertsMeanOfItsPlace) {
  const auto floor = prepare("luminaire/floor", small);
  const auto moved =
      prepare("luminaire/area",
              "{scene: {receiver: {position: [1.25, 0.25, 0], normal: [0, 0, 1]}, light: {polygon: "
              "[[.2, -.4, 1], [1.6, .3, 1.4], [-.3, 1.2, 1.1]], radiance: 1}}}");
  EXPECT_NEAR(floor.channel(2 * 6 + 5).mean.value(), moved.channel().mean.value(), 1e-12);
}

double correlation(const Sample& x, const Sample& y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.values.size(); ++i) {
    sum += (x.values[i] - x.mean()) * (y.values[i] - y.mean());
  }
  return sum / x.size() / std::sqrt(x.variance() * y.variance());
}

// False alarm of the first: 1e-6.
TEST(Floor, PixelsAreIndependentUnlessTheySharePoints) {
  const std::vector<Sample> own = observe(prepare("luminaire/floor", small), 4000);
  EXPECT_LT(std::abs(correlation(own[7], own[8])), five / std::sqrt(4000.0));
  const auto floor = prepare("luminaire/floor", "{width: 6, height: 4, size: 3, shared: true}");
  EXPECT_FALSE(floor.setup->image()->independent);
  const std::vector<Sample> shared = observe(floor, 4000);
  EXPECT_GT(correlation(shared[7], shared[8]), 0.5);
}

TEST(Floor, AMutantScalesSomePixelsAndNoOthers) {
  const auto floor = prepare("luminaire/floor", "{width: 16, height: 16}");
  const auto tile = prepare("mutants/floor_tile", "{width: 16, height: 16}");
  EXPECT_EQ(tile.key, floor.key);
  const std::vector<Sample> sound = observe(floor, 2);
  const std::vector<Sample> broken = observe(tile, 2);
  int changed = 0;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double ratio = broken[i].values[k] / sound[i].values[k];
      if (sound[i].values[k] == 0 || std::abs(ratio - 1) < 1e-12) continue;
      EXPECT_NEAR(ratio, 1.02, 1e-12);
      ++changed;
    }
  }
  EXPECT_GT(changed, 16);  // of 4 x 4 pixels, two observations
  EXPECT_LE(changed, 32);
}

TEST(Ramp, ComponentsStandTogetherAndHaveTheirMeans) {
  const auto ramp = prepare("analytic/ramp", "{width: 4, height: 2, colour: true}");
  const std::vector<Channel> channels = ramp.setup->channels();
  ASSERT_EQ(channels.size(), 24u);
  EXPECT_EQ(channels[3 * 3 + 2].name, "x3y0.blue");
  EXPECT_DOUBLE_EQ(channels[3 * 3 + 2].mean.value(), 6);
  EXPECT_DOUBLE_EQ(channels[(4 + 1) * 3 + 1].mean.value(), 3.2);
}

// Four pixels of means 1 and 10 and standard deviations half of those. The uniform law has sqrt 3
// standard deviations on both sides.
TEST(Ramp, EveryLawIsBroughtToTheStatedMeanAndVariance) {
  for (const char* law : {"normal(3, 2)", "exponential(2)", "uniform(-1, 5)"}) {
    const Channel bright =
        prepare("analytic/ramp",
                std::string("{width: 2, height: 2, spread: 0.5, law: ") + law + "}")
            .channel(1);
    EXPECT_DOUBLE_EQ(*bright.mean, 10) << law;
    EXPECT_DOUBLE_EQ(*bright.variance, 25) << law;
    if (law[0] != 'u') continue;
    EXPECT_NEAR(bright.low, 10 - 5 * std::numbers::sqrt3, 1e-13);
    EXPECT_NEAR(bright.high, 10 + 5 * std::numbers::sqrt3, 1e-13);
  }
  EXPECT_EQ(channel("analytic/ramp", "{spread: 0}").high, 1);
}

}  // namespace
}  // namespace assay
