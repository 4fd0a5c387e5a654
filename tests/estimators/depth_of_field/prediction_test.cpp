// Predictions of a pass through the middle of the lens, against closed forms.

#include "depth_of_field/prediction.h"

#include "depth_of_field/exact.h"
#include "depth_of_field/image.h"
#include "estimators/core/value.h"
#include "tests/prelude.h"

namespace assay::depth_of_field {
namespace {

Prediction predicted(const std::string& scene, const Grid& grid,
                     const PredictionRules& rules = wave_rules()) {
  return predict(Setting(read_scene(parse_flow(scene))), grid, rules);
}

/// Over a lens of radius 0.2 focused at 2, planes as given.
std::string behind_lens(const std::string& planes) {
  return "{lens: {radius: .2, focus: 2}, background: .25, planes: [" + planes + "]}";
}

/// An edge at x = 0 in front, dark where x > 0, before a wave.
std::string edge_before_wave(const std::string& depth) {
  return behind_lens(
      "{depth: 1, x: [0, 100], y: [-100, 100], radiance: 0}, {depth: " + depth +
      ", x: [-100, 100], y: [-100, 100], radiance: .5, amplitude: .4, wavelength: 1.5}");
}
constexpr double wave_behind = 2 * std::numbers::pi / 1.5;

/// Variances at the pixels, against coverages c (1 - c) of an edge. Bisection finds the edge to
/// half a thousandth of a pixel, and |dV / dt| is below 0.64.
void expect_edge(const Prediction& found, const Grid& grid,
                 const std::function<double(PlanePoint)>& distance) {
  for (std::size_t i = 0; i < grid.pixels(); ++i) {
    const double c = half_plane_coverage(distance(grid.pixel(i)));
    EXPECT_NEAR(found.variance[i], c * (1 - c), .64 * grid.pitch() / 2048 / .2 + 1e-6) << i;
  }
}

TEST(LensPrediction, OfAnEdgeIsTheVarianceOfWhatIsHidden) {
  const Grid rows{60, 2, 2};
  const Prediction found = predicted("edge", rows);
  expect_edge(found, rows, [](PlanePoint pixel) { return -pixel.x / .2; });
  // A ray a pixel and ten an edge, one edge a row.
  EXPECT_EQ(found.cost.camera_rays, 120u + 2 * 10);
  const Grid columns{2, 41, .1};
  const std::string across = behind_lens(
      "{depth: 1, x: [-100, 100], y: [-100, .013], radiance: 2}, {depth: 3, x: [-100, "
      "100], y: [-100, 100], radiance: 1}");
  expect_edge(predicted(across, columns), columns,
              [](PlanePoint pixel) { return (.013 - pixel.y / 2) / .1; });
}

// The claim of the suite: counts by prediction leave noise equal to 3 %.
TEST(LensPrediction, EqualisesTheNoiseOfAnEdge) {
  const Grid grid{120, 1, 2.32};
  const auto counts = lens_counts(predicted("edge", grid).variance, {64});
  double most = 0, least = 1;
  for (std::size_t i = 0; i < grid.pixels(); ++i) {
    const double c = half_plane_coverage(-grid.pixel(i).x / .2);
    if (c <= 0 || c >= 1) continue;
    const double noise = c * (1 - c) / static_cast<double>(counts[i]);
    most = std::max(most, noise);
    least = std::min(least, noise);
  }
  EXPECT_LT(most / least, 1.03);
}

// V = (1 - c) V_back + c V_front + c (1 - c) step^2. A wave has V = a^2 / 2 (1 - j^2). Planes are
// small: edges are off by 1e-7 of the largest coordinate.
TEST(LensPrediction, AddsWhatWavesAndEdgesVary) {
  const Grid grid{41, 1, 1};
  const std::string scene = behind_lens(
      "{depth: 1, x: [.002, 2], y: [-2, 2], radiance: .6, amplitude: .5, wavelength: .4}, "
      "{depth: 4, x: [-9, 9], y: [-9, 9], radiance: .3, amplitude: .2, wavelength: .9}");
  const Prediction found = predicted(scene, grid);
  const auto wave = [](double amplitude, double reach) {
    const double j = disc_response(reach);
    return amplitude * amplitude / 2 * (1 - j * j);
  };
  const double front = wave(.5, 2 * std::numbers::pi / .4 * .1);
  const double back = wave(.2, 2 * std::numbers::pi / .9 * .2);
  for (std::size_t i = 0; i < grid.pixels(); ++i) {
    const double x = grid.pixel(i).x;
    const double c = half_plane_coverage((x / 2 - .002) / .1);
    // Beyond the reach of the edge c is 0 or 1, and the formula that of one surface.
    const double expected = (1 - c) * back + c * front + c * (1 - c) * .09;
    EXPECT_NEAR(found.variance[i], std::max(expected, x / 2 > .002 ? front : back), 1e-5) << x;
  }
}

TEST(LensPrediction, OfCovariancesIsThatOfGaussianLenses) {
  const Grid grid{2, 1, 1};
  const auto found = predicted("sinusoid", grid, covariance_rules());
  // 1/8 (1 - 1 / sqrt(1 + z^2 / 2)), z = 3 radians.
  EXPECT_NEAR(found.variance[0], .125 * (1 - 1 / std::sqrt(1 + 4.5)), 1e-9);
  const double j = disc_response(3);
  EXPECT_NEAR(predicted("sinusoid", grid).variance[0], .125 * (1 - j * j), 1e-9);
}

TEST(LensPrediction, KnowsWhichPixelsSeeNothing) {
  const Grid grid{4, 1, 4};
  const auto found =
      predicted(behind_lens("{depth: 2, x: [-1, 1], y: [-100, 100], radiance: 1}"), grid);
  EXPECT_EQ(found.background, (std::vector<bool>{true, false, false, true}));
}

TEST(LensPrediction, LeavesOutEdgesThatRulesLeaveOut) {
  PredictionRules rules = wave_rules();
  rules.occludes = [](const Plane& front, const Lens&) { return front.depth > 1; };
  const Grid grid{60, 1, 2};
  for (const double v : predicted("edge", grid, rules).variance) EXPECT_EQ(v, 0);
}

// In front of the sharp plane a step passes up to 3.83 radians over the lens. That is 38.3 on the
// occluder, and half of that on the focal plane. Its waves are 16 % apart.
TEST(LensPrediction, AnEdgesBandwidthIsWhatTheLensLetsThrough) {
  const Grid grid{60, 1, 2};
  const Prediction found = predicted("edge", grid);
  const double most = first_zero_of_disc_response / .2;
  EXPECT_LE(found.bandwidth[30], most);
  EXPECT_GT(found.bandwidth[30], .84 * most);
  EXPECT_EQ(found.bandwidth[5], 0);
}

// The sum decides. Across the lens k is k_front / 2 - k_back (d / 2 - 1), which 19.2 bounds. Across
// the image it is k_front / 2 + k_back d / 2.
TEST(LensPrediction, WavesBehindAnEdgeTravelToItAndAddTheirFrequency) {
  const Grid grid{200, 1, 2};
  for (const double depth : {1.5, 2., 4., 7.}) {
    const Prediction found = predicted(edge_before_wave(std::to_string(depth)), grid);
    double least = 0, most = 0;
    for (const double k_back : {wave_behind, -wave_behind}) {
      const double bound =
          first_zero_of_disc_response / .2 - k_back * (1 - depth / 2);  // of k_front / 2
      most = std::max(most, bound + k_back * depth / 2);
      least = std::max(least, .84 * bound + k_back * depth / 2);
    }
    EXPECT_LE(found.bandwidth[100], most) << depth;
    EXPECT_GT(found.bandwidth[100], least) << depth;
  }
}

TEST(LensPrediction, AWaveWithoutPowerIsNotLetThrough) {
  const Lens lens{.2, 2};
  const std::vector<CameraFrequency> waves{{0, 5, 0}, {0, -3, 1}, {20, 9, 1}, {19, -4, 1}};
  EXPECT_EQ(image_bandwidth(waves, lens), 4);
  EXPECT_EQ(image_bandwidth({}, lens), 0);
}

}  // namespace
}  // namespace assay::depth_of_field
