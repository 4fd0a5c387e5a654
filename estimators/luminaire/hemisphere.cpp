// Irradiance from a luminaire by directions uniform in the hemisphere.
//
// X = 2 pi L cos(theta) [the ray hits the luminaire], density 1 / (2 pi): E[X] is the integral of
// L cos+ over the hemisphere. E[X^2] = 2 pi L^2 times the integral of cos+^2 over what is seen.

#include "render/hemisphere.h"

#include <numbers>

#include "luminaire/direction_sampler.h"

namespace assay::plugins {

namespace {

using namespace luminaire;

constexpr double two_pi = 2 * std::numbers::pi;

struct UniformDirections {
  render::Vector3 operator()(double u, double v) const { return render::uniform_hemisphere(u, v); }
  double density(const render::Vector3&) const { return 1 / two_pi; }
};

struct Primary {
  SharedSetting setting;

  LightSample draw(Stream& random) const {
    const double u = random.uniform();
    const double v = random.uniform();
    const render::Vector3 w = render::uniform_hemisphere(u, v);
    return {setting->ray(w), two_pi * setting->radiance() * w.z};
  }
  double value(const LightSample& sample, Cost& cost) const {
    return setting->sees_light(sample.ray, cost) ? sample.value : 0;
  }
};

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const SharedSetting setting = read_setting(parameters);
  const Channel channel = irradiance_channel(
      *setting, [](const ExactIntegrals& exact) { return two_pi * exact.squared_cosine; },
      two_pi * setting->radiance());
  return averaging(channel, Primary{setting},
                   {{"direction", std::make_shared<DirectionSampler<UniformDirections>>(setting)}});
}

}  // namespace

std::vector<Entry> luminaire_hemisphere() {
  return {{information("luminaire/hemisphere",
                       "Irradiance from a luminaire by directions uniform in the hemisphere.",
                       "X = 2 pi L cos(theta) where a ray along a uniform direction (density "
                       "1 / (2 pi)) first hits the emitting side of the luminaire, else 0. One "
                       "closest-hit ray a sample. Sampler: direction."),
           prepare}};
}

}  // namespace assay::plugins
