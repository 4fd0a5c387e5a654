// Lens integration at a pixel against independent quadrature, and the transport of frequencies.

#include "depth_of_field/exact.h"
#include "depth_of_field/spectrum.h"
#include "tests/estimators/prelude.h"

namespace assay::depth_of_field {
namespace {

const char* const corner =
    "{lens: {radius: .2, focus: 2}, background: .3, planes: [{depth: 1, x: [0, 100], y: [-100, "
    ".02], radiance: 0}, {depth: 3, x: [-.1, .05], y: [-.1, 100], radiance: .5, amplitude: .5, "
    "wavelength: .1, phase: .4}]}";

SceneDescription scene_of(const std::string& name) {
  if (name == "corner") return read_scene(parse_flow(corner));
  return read_scene(parse_flow(name));
}

TEST(DepthOfField, MomentsAreThoseOfAnIndependentQuadrature) {
  for (const auto& row : tests::table("depth_of_field.csv")) {
    if (row[0] == "parseval") continue;
    const PlanePoint pixel{std::stod(row[1]), std::stod(row[2])};
    const Moments moments = exact_moments(scene_of(row[0]), pixel);
    EXPECT_NEAR(moments.mean, std::stod(row[3]), 1e-10) << row[0] << row[1];
    EXPECT_NEAR(moments.square, std::stod(row[4]), 1e-10) << row[0] << row[1];
  }
}

/// An edge before a wave of this length.
std::string cut_wave(const char* wavelength) {
  return std::string(
             "{scene: {lens: {radius: .2, focus: 2}, planes: [{depth: 1, x: [.003, 100], y: "
             "[-100, 100], radiance: 0}, {depth: 4, x: [-100, 100], y: [-100, 100], "
             "radiance: .5, amplitude: .5, wavelength: ") +
         wavelength + "}]}, pixel: [.0012, .07]}";
}

// Waves of 126 and of 1257 radians in the radius: quadrature resolves the one, not the other.
TEST(DepthOfField, AVarianceIsStatedOnlyWhereItsErrorIsSmall) {
  const Channel coarse = channel("depth_of_field/pixel", cut_wave("1e-2"));
  EXPECT_LT(coarse.mean_error, 1e-13);
  EXPECT_TRUE(coarse.variance);
  const Channel fine = channel("depth_of_field/pixel", cut_wave("1e-3"));
  EXPECT_GT(fine.mean_error, 1e-8);
  EXPECT_FALSE(fine.variance);
}

// At 1e-7 from the rim V is 2e-10 of the square, and rounding may take 4e-15 of that.
TEST(DepthOfField, AVarianceThatRoundingLeftIsNotStated) {
  const auto variance = [](const char* x) {
    return channel("depth_of_field/pixel", std::string("{scene: edge, pixel: [") + x + ", 0]}")
        .variance;
  };
  EXPECT_TRUE(variance("-.199"));
  EXPECT_FALSE(variance("-.1999999"));
  EXPECT_FALSE(variance("-.21"));
}

TEST(DepthOfField, TheErrorOfAVarianceIsThatOfBothMoments) {
  const Moments moments{.mean = 3, .square = 10, .error = 1e-3};
  const Moments off{.mean = 3 - 1e-3, .square = 10 + 1e-3};
  EXPECT_NEAR(off.variance() - moments.variance(), moments.variance_error(), 2e-6);
}

// By Parseval the power off the axis is the variance over the lens, whose phases are averaged.
TEST(DepthOfField, ThePowerOffTheAxisIsTheVarianceOverTheLens) {
  const Lens lens{.2, 2};
  for (const auto& row : tests::table("depth_of_field.csv")) {
    if (row[0] != "parseval") continue;
    const auto waves =
        Spectrum({{std::stod(row[2]), 0, .5}}).travel(std::stod(row[1])).at_camera(lens);
    EXPECT_NEAR(lens_variance(waves, lens), std::stod(row[3]), 1e-9);
  }
}

/// A point in phase space moves by (x, v) -> M (x, v), a wave W . (x, v) keeps its phase.
TEST(DepthOfField, TravelAndCurvatureKeepThePhaseOfEveryRay) {
  const Frequency wave{3, -2, 1};
  const double x = .7;
  const double v = -.4;
  const Frequency travelled = Spectrum({wave}).travel(1.5).waves()[0];
  EXPECT_NEAR(travelled.position * (x + 1.5 * v) + travelled.slope * v,
              wave.position * x + wave.slope * v, 1e-14);
  const Frequency curved = Spectrum({wave}).curve(.8).waves()[0];
  EXPECT_NEAR(curved.position * x + curved.slope * (v + .8 * x), wave.position * x + wave.slope * v,
              1e-14);
}

// A wave on a plane, followed along lens rays to the camera. Its frequencies are the derivatives of
// its phase by lens point and by pixel.
TEST(DepthOfField, FrequenciesAtTheCameraAreDerivativesOfThePhase) {
  const Lens lens{.3, 2};
  for (const double depth : {.5, 2., 7.}) {
    const auto waves = Spectrum({{5, 0, 1}}).travel(depth).at_camera(lens);
    const auto phase = [&](double u, double pixel) {
      return 5 * footprint(lens, {pixel, 0}, depth).at({u / lens.radius, 0}).x;
    };
    EXPECT_NEAR(waves[0].lens, phase(1, 0) - phase(0, 0), 1e-12);
    EXPECT_NEAR(waves[0].image, phase(0, 1) - phase(0, 0), 1e-12);
  }
}

TEST(DepthOfField, AMaskMovesWavesToBothSides) {
  const std::array<MaskWave, 1> mask{{{7, .25}}};
  const auto waves = Spectrum({{2, 1, 4}}).occlude(mask).waves();
  ASSERT_EQ(waves.size(), 3u);
  EXPECT_EQ(waves[1].position, 9);
  EXPECT_EQ(waves[2].position, -5);
  EXPECT_EQ(waves[2].slope, 1);
  EXPECT_EQ(waves[1].power, 1);
}

TEST(DepthOfField, ForLowFrequenciesTheCovariancePredictsTheDiscsVariance) {
  const Lens lens{.1, 2};
  const auto waves = Spectrum({{.5, 0, 1}}).travel(3).at_camera(lens);
  const Covariance covariance = Covariance(1, {.position = .25}).travel(3);
  EXPECT_NEAR(covariance.lens_variance(lens) / lens_variance(waves, lens), 1, 1e-3);
}

}  // namespace
}  // namespace assay::depth_of_field
