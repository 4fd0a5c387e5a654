// The samplers inside the luminaire family against the densities they declare.

#include <boost/math/distributions/chi_squared.hpp>

#include "tests/estimators/prelude.h"
#include "tests/estimators/scenes.h"

namespace assay {
namespace {

constexpr std::uint64_t draw_count = 1u << 20;

// p of 32 x 32 equiprobable cells of two coordinates in [0, 1).
double uniform_p(const Sampler& sampler,
                 const std::function<std::array<double, 2>(const Point&)>& coordinates) {
  constexpr std::size_t side = 32;
  std::vector<double> cells(side * side);
  Stream random(stream_key(1, "samplers_test", "", 0), 0);
  for (std::uint64_t i = 0; i < draw_count; ++i) {
    const auto [u, v] = coordinates(sampler.sample(random).point);
    const auto cell = [](double x) { return std::min(side - 1, std::size_t(x * double(side))); };
    ++cells[cell(u) * side + cell(v)];
  }
  const double expected = double(draw_count) / double(cells.size());
  double statistic = 0;
  for (const double count : cells) statistic += (count - expected) * (count - expected) / expected;
  const boost::math::chi_squared law(double(cells.size()) - 1);
  return boost::math::cdf(boost::math::complement(law, statistic));
}

double azimuth(const Point& p) {
  const double turns = std::atan2(p[1], p[0]) / (2 * std::numbers::pi);
  return turns < 0 ? turns + 1 : turns;
}

// Maps from each sampler's points to the unit square that make its declared density constant. The
// false-alarm rate of each expectation is 1e-4.

std::array<double, 2> hemisphere(const Point& p) { return {p[2], azimuth(p)}; }
std::array<double, 2> cosine(const Point& p) { return {p[2] * p[2], azimuth(p)}; }
// For (u, v) uniform in the triangle 1 - u has distribution x^2, and v / (1 - u) is uniform.
std::array<double, 2> triangle(const Point& p) {
  return {(1 - p[0]) * (1 - p[0]), p[1] / (1 - p[0])};
}
std::array<double, 2> square(const Point& p) { return {p[0], p[1]}; }

TEST(LuminaireSamplers, FollowTheirDensitiesUnlessTheyAreMutated) {
  struct Case {
    const char* plugin;
    const char* sampler;
    std::array<double, 2> (*map)(const Point&);
    bool sound = true;
  };
  for (const auto& [plugin, sampler, map, sound] :
       {Case{"luminaire/hemisphere", "direction", hemisphere},
        {"luminaire/cosine", "direction", cosine},
        {"luminaire/area", "point", triangle},
        {"luminaire/solid_angle", "square", square},
        {"mutants/nonuniform_triangle", "point", triangle, false},
        {"mutants/arvo_uniform_arc", "square", square, false},
        {"mutants/arvo_uniform_angle", "square", square, false}}) {
    const double p = uniform_p(*prepare(plugin, draws::scene("triangle")).sampler(sampler), map);
    if (sound) {
      EXPECT_GT(p, 1e-4) << plugin;
    } else {
      EXPECT_LT(p, 1e-9) << plugin;
    }
  }
}

// The weights' mean is the integral of evaluate(): the irradiance. False-alarm rate 1e-4 each.
TEST(LuminaireSamplers, WeightsAverageToTheIrradiance) {
  for (const char* plugin :
       {"luminaire/hemisphere", "luminaire/cosine", "luminaire/area", "luminaire/solid_angle"}) {
    const auto setup = draws::prepare(plugin, draws::scene("triangle")).setup;
    for (const NamedSampler& named : setup->samplers()) {
      Stream random(stream_key(1, plugin, named.name, 0), 0);
      Sample weights;
      for (int i = 0; i < 1 << 18; ++i) {
        const SamplerDraw draw = named.sampler->sample(random);
        EXPECT_TRUE(draw.valid);
        EXPECT_NEAR(draw.weight * draw.density, named.sampler->evaluate(draw.point), 1e-9);
        weights.values.push_back(draw.weight);
      }
      EXPECT_NEAR(weights.mean(), 0.481046907316, four * weights.mean_error())
          << plugin << '.' << named.name;
    }
  }
}

TEST(LuminaireSamplers, SolidAngleDirectionsLieInsideAndHaveDensityOneOverOmega) {
  for (const std::string& scene :
       {std::string("triangle"), std::string("rectangle"), horizon_scene}) {
    const auto sampler = prepare("luminaire/solid_angle", draws::scene(scene)).sampler("direction");
    EXPECT_EQ(sampler->domain(), scene == horizon_scene ? Domain::sphere : Domain::hemisphere);
    Stream random(stream_key(1, "solid_angle", scene, 0), 0);
    int outside = 0;
    for (int i = 0; i < 10000; ++i) {
      const SamplerDraw draw = sampler->sample(random);
      outside += sampler->density(draw.point) != draw.density;
    }
    // Only rounding at the outline itself can put a direction outside.
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(sampler->density({0, 0, -1}), 0);
  }
}

}  // namespace
}  // namespace assay
