#include "estimators/path_tracing/image.h"
#include "stats/basics/moments.h"
#include "tests/prelude.h"

namespace assay::path_tracing {
namespace {

constexpr Scene::Camera unused{};

/// A room whose six walls emit radiance 1, around a ball.
Scene furnace(const Material& ball) {
  const Material light{.surface = Surface::emitter, .colour = {1, 1, 1}};
  const double a = 3;
  std::vector<Shape> shapes{sphere({0, 0, 0}, 1, ball)};
  for (const double side : {-a, a}) {
    const Vector3 x{2 * a, 0, 0};
    const Vector3 y{0, 2 * a, 0};
    const Vector3 z{0, 0, 2 * a};
    const bool low = side < 0;
    shapes.push_back(parallelogram({-a, -a, side}, low ? x : y, low ? y : x, light));
    shapes.push_back(parallelogram({-a, side, -a}, low ? z : x, low ? x : z, light));
    shapes.push_back(parallelogram({side, -a, -a}, low ? y : z, low ? z : y, light));
  }
  return {std::move(shapes), unused, 4};
}

stats::Moments green_of(const Scene& scene, Integrator integrator, const Ray& ray,
                        std::uint64_t paths) {
  stats::Moments moments;
  Cost cost;
  for (std::uint64_t i = 0; i < paths; ++i) {
    Stream random(stream_key(1, "path_tracing_test", "", 0), i);
    moments.add(radiance(scene, integrator, {}, ray, random, cost)[1]);
  }
  return moments;
}

constexpr Integrator all[] = {Integrator::light, Integrator::bsdf, Integrator::multiple};
const Ray at_the_ball{{0, 0.3, 2.5}, {0, 0, -1}};

double error_of(const stats::Moments& moments) {
  const auto count = static_cast<double>(moments.count);
  return std::sqrt(moments.m2 / (count * (count - 1)));
}

/// Beyond it with probability 1e-6 for normal means.
void expect_mean(const stats::Moments& moments, double expected) {
  EXPECT_NEAR(moments.mean, expected, 4.9 * error_of(moments) + 1e-12);
}

TEST(PathTracing, ADiffuseBallInAFurnaceHasItsAlbedo) {
  const Scene scene = furnace({.surface = Surface::diffuse, .colour = {.2, .7, .9}});
  for (const Integrator integrator : all) {
    expect_mean(green_of(scene, integrator, at_the_ball, 20000), .7);
  }
}

// Every path ends at a wall: no light is lost or won.
TEST(PathTracing, GlassInAFurnaceIsInvisibleAndAMirrorHasItsColour) {
  const Scene glass = furnace({.surface = Surface::glass, .refraction = 1.5});
  const Scene mirror = furnace({.surface = Surface::mirror, .colour = {.9, .8, .7}});
  for (const Integrator integrator : all) {
    const stats::Moments of_glass = green_of(glass, integrator, at_the_ball, 2000);
    EXPECT_EQ(of_glass.minimum, 1);
    EXPECT_EQ(of_glass.maximum, 1);
    EXPECT_DOUBLE_EQ(green_of(mirror, integrator, at_the_ball, 10).mean, .8);
  }
}

TEST(PathTracing, AGlossyBallInAFurnaceReflectsNoMoreThanItGets) {
  for (const double exponent : {1.0, 30.0, 1000.0}) {
    const Scene scene =
        furnace({.surface = Surface::glossy, .colour = {1, 1, 1}, .exponent = exponent});
    const stats::Moments by_bsdf = green_of(scene, Integrator::bsdf, at_the_ball, 20000);
    const stats::Moments by_both = green_of(scene, Integrator::multiple, at_the_ball, 20000);
    EXPECT_LE(by_bsdf.mean, 1 + 4.9 * error_of(by_bsdf)) << exponent;
    EXPECT_NEAR(by_bsdf.mean, by_both.mean, 4.9 * std::hypot(error_of(by_bsdf), error_of(by_both)))
        << exponent;
  }
}

// A diffuse floor under a square light: the midpoint rule on the light's area.
TEST(PathTracing, ALampOverAFloorGivesTheIntegralOverItsArea) {
  const double radiance = 5;
  const double height = 2;
  const Scene scene(
      {parallelogram({-9, 0, -9}, {0, 0, 18}, {18, 0, 0},
                     {.surface = Surface::diffuse, .colour = {.5, .5, .5}}),
       parallelogram({-1, height, -1}, {2, 0, 0}, {0, 0, 2},
                     {.surface = Surface::emitter, .colour = {radiance, radiance, radiance}})},
      unused, 1);
  const Vector3 point{0.5, 0, 0.2};
  double expected = 0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const Vector3 to{-1 + 2 * (i + .5) / steps - point.x, height,
                       -1 + 2 * (j + .5) / steps - point.z};
      const double squared = squared_length(to);
      expected += .5 / std::numbers::pi * radiance * height * height / (squared * squared);
    }
  }
  expected *= 4.0 / (steps * steps);
  const Vector3 eye{3, 1, 2};
  const Ray ray{eye, render::normalised(point - eye)};
  for (const Integrator integrator : all) {
    expect_mean(green_of(scene, integrator, ray, 40000), expected);
  }
}

TEST(PathTracing, APictureIsAFunctionOfSeedAndIndex) {
  const Picture picture{.scene = scene_of("glass"), .width = 8, .height = 6};
  const auto rendered = [&](std::uint64_t index) {
    std::vector<double> out(8 * 6 * 3);
    Stream random(stream_key(3, "path_tracing_test", "", 0), index);
    Cost cost;
    render(picture, random, 2, out, cost);
    return out;
  };
  EXPECT_EQ(rendered(4), rendered(4));
  EXPECT_NE(rendered(4), rendered(5));
}

}  // namespace
}  // namespace assay::path_tracing
