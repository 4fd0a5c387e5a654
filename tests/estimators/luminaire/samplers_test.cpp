// The samplers inside the luminaire family against the densities they declare.

#include <boost/math/distributions/chi_squared.hpp>

#include "tests/estimators/draws.h"
#include "tests/estimators/scenes.h"
#include "tests/prelude.h"

namespace assay {
namespace {

constexpr std::uint64_t draw_count = 1u << 20;

const Sampler& sampler_of(const std::shared_ptr<const Setup>& setup, const std::string& name,
                          std::shared_ptr<const Sampler>& keep) {
  for (const NamedSampler& named : setup->samplers()) {
    if (named.name == name) keep = named.sampler;
  }
  if (!keep) throw std::logic_error("no sampler " + name);
  return *keep;
}

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

double hemisphere_p(const Sampler& sampler) {
  return uniform_p(sampler, [](const Point& p) { return std::array{p[2], azimuth(p)}; });
}

double cosine_p(const Sampler& sampler) {
  return uniform_p(sampler, [](const Point& p) { return std::array{p[2] * p[2], azimuth(p)}; });
}

// For (u, v) uniform in the triangle 1 - u has distribution x^2, and v / (1 - u) is uniform.
double triangle_p(const Sampler& sampler) {
  return uniform_p(sampler, [](const Point& p) {
    const double rest = 1 - p[0];
    return std::array{rest * rest, p[1] / rest};
  });
}

double square_p(const Sampler& sampler) {
  return uniform_p(sampler, [](const Point& p) { return std::array{p[0], p[1]}; });
}

struct Case {
  const char* plugin;
  const char* sampler;
  double (*p_value)(const Sampler&);
};

const std::vector<Case> cases = {{"luminaire/hemisphere", "direction", hemisphere_p},
                                 {"luminaire/cosine", "direction", cosine_p},
                                 {"luminaire/area", "point", triangle_p},
                                 {"luminaire/solid_angle", "square", square_p}};

TEST(LuminaireSamplers, FollowTheirDensities) {
  for (const Case& c : cases) {
    std::shared_ptr<const Sampler> keep;
    EXPECT_GT(c.p_value(sampler_of(draws::prepare(c.plugin, draws::scene("triangle")).setup,
                                   c.sampler, keep)),
              1e-4)
        << c.plugin;
  }
}

TEST(LuminaireSamplers, MutatedOnesDoNot) {
  for (const Case& c : {Case{"mutants/nonuniform_triangle", "point", triangle_p},
                        Case{"mutants/arvo_uniform_arc", "square", square_p},
                        Case{"mutants/arvo_uniform_angle", "square", square_p}}) {
    std::shared_ptr<const Sampler> keep;
    EXPECT_LT(c.p_value(sampler_of(draws::prepare(c.plugin, draws::scene("triangle")).setup,
                                   c.sampler, keep)),
              1e-9)
        << c.plugin;
  }
}

// The weights' mean is the integral of evaluate(): the irradiance. False-alarm rate 1e-6 each.
TEST(LuminaireSamplers, WeightsAverageToTheIrradiance) {
  for (const char* plugin :
       {"luminaire/hemisphere", "luminaire/cosine", "luminaire/area", "luminaire/solid_angle"}) {
    const auto setup = draws::prepare(plugin, draws::scene("triangle")).setup;
    for (const NamedSampler& named : setup->samplers()) {
      Stream random(stream_key(1, plugin, named.name, 0), 0);
      double sum = 0;
      double squares = 0;
      constexpr double count = 1 << 18;
      for (int i = 0; i < int(count); ++i) {
        const SamplerDraw draw = named.sampler->sample(random);
        EXPECT_TRUE(draw.valid);
        EXPECT_NEAR(draw.weight * draw.density, named.sampler->evaluate(draw.point), 1e-9);
        sum += draw.weight;
        squares += draw.weight * draw.weight;
      }
      const double mean = sum / count;
      const double error = std::sqrt((squares / count - mean * mean) / count);
      EXPECT_LT(std::abs(mean - 0.481046907316) / error, draws::five)
          << plugin << '.' << named.name;
    }
  }
}

TEST(LuminaireSamplers, SolidAngleDirectionsLieInsideAndHaveDensityOneOverOmega) {
  for (const std::string& scene :
       {std::string("triangle"), std::string("rectangle"), horizon_scene}) {
    std::shared_ptr<const Sampler> keep;
    const Sampler& sampler = sampler_of(
        draws::prepare("luminaire/solid_angle", draws::scene(scene)).setup, "direction", keep);
    EXPECT_EQ(sampler.domain(),
              scene == tests::horizon_scene ? Domain::sphere : Domain::hemisphere);
    Stream random(stream_key(1, "solid_angle", scene, 0), 0);
    int outside = 0;
    for (int i = 0; i < 10000; ++i) {
      const SamplerDraw draw = sampler.sample(random);
      outside += sampler.density(draw.point) != draw.density;
    }
    // Only rounding at the outline itself can put a direction outside.
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(sampler.density({0, 0, -1}), 0);
  }
}

}  // namespace
}  // namespace assay
