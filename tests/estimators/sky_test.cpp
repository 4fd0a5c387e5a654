#include "render/polygon.h"
#include "sky/octahedron.h"
#include "sky/radiance.h"
#include "tests/estimators/prelude.h"

namespace assay {
namespace {

using render::normalised;
using render::Vector3;

const std::string harmonic_sky = "{harmonics: [3, .4, -.3, .5, .2, -.35, .3, .25, -.2]}";

double irradiance(const std::string& sky, const std::string& normal = "[0, 0, 1]") {
  return *channel("sky/cosine", "{sky: " + sky + ", normal: " + normal + "}").mean;
}

// Constants of Ramamoorthi and Hanrahan (2001), equation 3.
TEST(Harmonics, AreThoseOfTheLiterature) {
  const Vector3 w = normalised({.3, -.5, .8});
  const sky::Harmonics y = sky::harmonics(w);
  EXPECT_NEAR(y[0], .282095, 1e-6);
  EXPECT_NEAR(y[1], .488603 * w.y, 1e-6);
  EXPECT_NEAR(y[2], .488603 * w.z, 1e-6);
  EXPECT_NEAR(y[3], .488603 * w.x, 1e-6);
  EXPECT_NEAR(y[4], 1.092548 * w.x * w.y, 1e-6);
  EXPECT_NEAR(y[5], 1.092548 * w.y * w.z, 1e-6);
  EXPECT_NEAR(y[6], .315392 * (3 * w.z * w.z - 1), 1e-6);
  EXPECT_NEAR(y[7], 1.092548 * w.x * w.z, 1e-6);
  EXPECT_NEAR(y[8], .546274 * (w.x * w.x - w.y * w.y), 1e-6);
}

// The addition theorem: sum over m of Y_lm^2 = (2 l + 1) / (4 pi).
TEST(Harmonics, ObeyTheAdditionTheorem) {
  const sky::Harmonics y = sky::harmonics(normalised({-.2, .9, .4}));
  for (std::size_t l = 0; l <= sky::highest_band; ++l) {
    double sum = 0;
    for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) sum += y[i] * y[i];
    EXPECT_NEAR(sum, static_cast<double>(2 * l + 1) / (4 * pi), 1e-14) << l;
  }
}

TEST(Octahedron, IsAClosedSphereOfEightTimesAPowerOfFourTriangles) {
  const sky::Octahedron sphere(4);
  EXPECT_EQ(sphere.triangles().size(), 2048u);
  EXPECT_EQ(sphere.vertices().size(), 1026u);  // V = F / 2 + 2 (Euler)
  double solid_angle = 0;
  for (std::size_t t = 0; t < sphere.triangles().size(); ++t) {
    const auto [a, b, c] = sphere.corners(t);
    EXPECT_GT(dot(cross(b - a, c - a), a), 0) << "counter-clockwise from outside";
    solid_angle += render::solid_angle(a, b, c);
  }
  EXPECT_NEAR(solid_angle, 4 * pi, 1e-10);
}

TEST(Octahedron, FindsTheTriangleOfADirection) {
  const sky::Octahedron sphere(5);
  for (std::size_t t = 0; t < sphere.triangles().size(); ++t) {
    const auto [a, b, c] = sphere.corners(t);
    EXPECT_EQ(sphere.triangle(.2 * a + .3 * b + .5 * c), t);
    EXPECT_EQ(sphere.triangle(.96 * a + .02 * b + .02 * c), t);
  }
  EXPECT_THROW(sky::Octahedron(10), std::invalid_argument);
}

TEST(Skies, HaveTheIrradiancesOfTheirClosedForms) {
  EXPECT_NEAR(irradiance("{uniform: 2}", "[1, 2, 3]"), 2 * pi, 1e-12);
  EXPECT_NEAR(irradiance(harmonic_sky, "[.3, -.5, .8]"), 2.593043473, 1e-9);
  EXPECT_NEAR(irradiance("{gradient: {base: 1, slope: [.5, 0, .3]}}"), pi + 2 * pi / 3 * .3, 1e-12);
  EXPECT_NEAR(irradiance("{gradient: {base: 1, slope: [.5, 0, .3]}}", "[1, 0, 0]"),
              pi + 2 * pi / 3 * .5, 1e-12);
}

// Along its axis a lobe gives 2 pi times the integral of c e^(k (c - 1)) over [0, 1]. With
// sharpness 1e-9 it is a uniform sky.
TEST(Skies, APeakHasItsIrradianceWhateverTheNormal) {
  const std::string up = "{peak: {base: .2, height: 20, sharpness: 60, direction: [0, 0, 1]}}";
  const double k = 60;
  const double lobe = 2 * pi * (1 / k - (1 - std::exp(-k)) / (k * k));
  EXPECT_NEAR(irradiance(up), .2 * pi + 20 * lobe, 1e-12);
  EXPECT_NEAR(irradiance("{peak: {base: 0, height: 1, sharpness: 1e-9, direction: [1, 0, 1]}}",
                         "[0, 1, 2]"),
              pi, 1e-8);
  // Light below the horizon of one normal is above that of its opposite. Together they make the
  // integral of |cos|, the same from the lobe's two ends.
  const std::string tilted = "{peak: {base: .2, height: 20, sharpness: 3, direction: [1, 1, 1]}}";
  const auto both = [&](const std::string& n, const std::string& opposite) {
    return irradiance(tilted, n) + irradiance(tilted, opposite);
  };
  EXPECT_NEAR(both("[1, 0, 0]", "[-1, 0, 0]"), both("[0, 1, 0]", "[0, -1, 0]"), 1e-11);
}

// pi / 2 + 2 / 3 bx + pi / 3 bz behind a wall; pi cos^2 30 behind a disc. False alarm 1e-6 each.
TEST(Skies, AreHiddenByOccluders) {
  const auto walled = prepare(
      "sky/cosine",
      "{sky: {gradient: {base: 1, slope: [.5, 0, .3]}}, occluders: [{polygon: [[-.001, -1000, "
      "-1000], [-.001, 1000, -1000], [-.001, 1000, 1000], [-.001, -1000, 1000]]}]}");
  const auto disc = prepare("sky/cosine",
                            "{sky: {uniform: 1}, occluders: [{disc: {center: [0, 0, 1], normal: "
                            "[0, 0, 1], radius: 0.5773502691896258}}]}");
  EXPECT_THAT(observe(walled, 400000)[0], HasMean(pi / 2 + 1. / 3 + .1 * pi));
  EXPECT_THAT(observe(disc, 400000)[0], HasMean(.75 * pi));
  EXPECT_FALSE(walled.channel().mean) << "no closed form past occluders";
}

}  // namespace
}  // namespace assay
