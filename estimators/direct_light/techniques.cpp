#include "direct_light/techniques.h"

#include <utility>

namespace assay::direct_light {

using render::Vector3;

Techniques::Techniques(luminaire::SharedSetting setting, SharedReflectance reflectance,
                       SharedLightSampling light_sampling)
    : setting_(std::move(setting)),
      reflectance_(std::move(reflectance)),
      light_sampling_(std::move(light_sampling)) {}

double Techniques::integrand(const Vector3& w) const {
  return w.z > 0 ? setting_->radiance() * reflectance_->value(w) * w.z : 0;
}

Pair Techniques::density(const luminaire::LightTriangle& triangle, const Vector3& w) const {
  return {light_sampling_->density(triangle, w), reflectance_->density(w)};
}

Draw Techniques::light(Stream& random, Cost& cost) const {
  const std::optional<LightPoint> point = light_sampling_->sample(random);
  if (!point) return {};
  const Vector3 w = normalised(point->to_light);
  const luminaire::LightSample sample{luminaire::shadow_ray(point->to_light), integrand(w)};
  return {setting_->received(sample, cost), {point->density, reflectance_->density(w)}};
}

Draw Techniques::brdf(Stream& random, Cost& cost) const {
  const Vector3 w = reflectance_->sample(random);
  if (w.z <= 0) return {};
  const luminaire::LightTriangle* const triangle = setting_->first_hit(setting_->ray(w), cost);
  if (!triangle || !triangle->emits) return {};
  return {integrand(w), density(*triangle, w)};
}

}  // namespace assay::direct_light
