#include <numbers>

#include "luminaire/solid_angle.h"
#include "render/hemisphere.h"

namespace assay::plugins {

namespace {

using namespace luminaire;

constexpr double pi = std::numbers::pi;
constexpr double two_pi = 2 * pi;

/// Uniform in the projected hemisphere: the cosines cancel.
struct CosineDirections : render::CosineHemisphere {
  static constexpr double most = pi;
  static double value(double radiance, const render::Vector3&) { return pi * radiance; }
  static double second_moment(const ExactIntegrals& exact) { return pi * exact.irradiance; }
};

struct UniformDirections : render::UniformHemisphere {
  static constexpr double most = two_pi;
  static double value(double radiance, const render::Vector3& w) { return two_pi * radiance * w.z; }
  static double second_moment(const ExactIntegrals& exact) { return two_pi * exact.squared_cosine; }
};

template <class Directions>
struct Primary {
  SharedSetting setting;

  LightSample draw(Stream& random) const {
    const double u = random.uniform();
    const double v = random.uniform();
    const render::Vector3 w = Directions{}(u, v);
    return {setting->ray(w), Directions::value(setting->radiance(), w)};
  }
  double value(const LightSample& sample, Cost& cost) const {
    return setting->sees_light(sample.ray, cost) ? sample.value : 0;
  }
};

template <class Directions>
std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const SharedSetting setting = read_setting(parameters);
  const auto point = [](Stream& random) -> std::optional<Point> {
    const double u = random.uniform();
    return point_of(Directions{}(u, random.uniform()));
  };
  const auto density = [](const Point& p) { return Directions{}.density(render::vector_of(p)); };
  const auto evaluate = [setting](const Point& p) {
    const bool lit = setting->sees_light(setting->ray(render::vector_of(p)), Uncounted());
    return lit ? setting->radiance() * p[2] : 0;
  };
  return averaging(irradiance_channel(*setting, Directions::second_moment,
                                      Directions::most * setting->radiance()),
                   Primary<Directions>{setting},
                   {{"direction", sampler_of({Domain::hemisphere, point, density, evaluate})}});
}

}  // namespace

std::vector<Entry> luminaire_directions() {
  return {
      {information("luminaire/cosine",
                   "Irradiance from a luminaire by directions of density cos(theta) / pi.",
                   "X = pi L where a ray along a direction uniform in the projected hemisphere "
                   "first hits the emitting side of the luminaire, else 0: a Bernoulli variable "
                   "of variance E (pi L - E). One closest-hit ray a sample. Sampler: "
                   "direction."),
       prepare<CosineDirections>},
      {information("luminaire/hemisphere",
                   "Irradiance from a luminaire by directions uniform in the hemisphere.",
                   "X = 2 pi L cos(theta) where a ray along a uniform direction (density "
                   "1 / (2 pi)) first hits the emitting side of the luminaire, else 0. One "
                   "closest-hit ray a sample. Sampler: direction."),
       prepare<UniformDirections>}};
}

}  // namespace assay::plugins
