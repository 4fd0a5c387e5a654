// Irradiance from a luminaire by directions uniform in the projected hemisphere.
//
// X = pi L [the ray hits the luminaire], density cos(theta) / pi: the cosines cancel. X is pi L
// times a Bernoulli variable of mean E / (pi L), so its variance is E (pi L - E).

#include <numbers>

#include "luminaire/direction_sampler.h"
#include "render/hemisphere.h"

namespace assay::plugins {

namespace {

using namespace luminaire;

constexpr double pi = std::numbers::pi;

struct CosineDirections {
  render::Vector3 operator()(double u, double v) const { return render::cosine_hemisphere(u, v); }
  double density(const render::Vector3& w) const { return std::max(0.0, w.z) / pi; }
};

struct Primary {
  SharedSetting setting;

  render::RoundedRay draw(Stream& random) const {
    const double u = random.uniform();
    const double v = random.uniform();
    return setting->ray(render::cosine_hemisphere(u, v));
  }
  double value(const render::RoundedRay& ray, Cost& cost) const {
    return setting->sees_light(ray, cost) ? pi * setting->radiance() : 0;
  }
};

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const SharedSetting setting = read_setting(parameters);
  const Channel channel = irradiance_channel(
      *setting, [](const ExactIntegrals& exact) { return pi * exact.irradiance; },
      pi * setting->radiance());
  return averaging(channel, Primary{setting},
                   {{"direction", std::make_shared<DirectionSampler<CosineDirections>>(setting)}});
}

}  // namespace

std::vector<Entry> luminaire_cosine() {
  return {
      {information("luminaire/cosine",
                   "Irradiance from a luminaire by directions of density cos(theta) / pi.",
                   "X = pi L where a ray along a direction uniform in the projected hemisphere "
                   "first hits the emitting side of the luminaire, else 0: a Bernoulli variable "
                   "of variance E (pi L - E). One closest-hit ray a sample. Sampler: "
                   "direction."),
       prepare}};
}

}  // namespace assay::plugins
