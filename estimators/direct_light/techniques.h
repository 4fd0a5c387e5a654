#pragma once

// The two techniques of direct lighting, each of which knows the density of the other.

#include <memory>

#include "direct_light/heuristic.h"
#include "direct_light/light_sampling.h"
#include "direct_light/reflectance.h"

namespace assay::direct_light {

/// A direction that a technique drew.
struct Draw {
  double integrand = 0;  ///< L f cos V there; 0 also where no direction came out
  Pair density;          ///< with which each technique draws it, per solid angle; where it counts
};

/// The light from the luminaire that the surface reflects towards the viewer:
///   L_r = integral over directions w of L(w) f(w, viewer) max(0, n . w) dw.
/// L(w) is the radiance of the luminaire if a ray along w hits it first, else 0.
class Techniques {
 public:
  Techniques(luminaire::SharedSetting setting, SharedReflectance reflectance,
             SharedLightSampling light_sampling);
  virtual ~Techniques() = default;

  /// A point of the luminaire and a shadow ray to it; none where nothing would arrive.
  virtual Draw light(Stream& random, Cost& cost) const;
  /// A direction of the BRDF and the closest hit along it; no ray below the horizon.
  virtual Draw brdf(Stream& random, Cost& cost) const;

  /// L f cos at a direction in which the luminaire is seen.
  double integrand(const render::Vector3& w) const;
  /// The densities of both at a direction in which a triangle of the luminaire is seen.
  Pair density(const luminaire::LightTriangle& triangle, const render::Vector3& w) const;

  const luminaire::Setting& setting() const { return *setting_; }
  const Reflectance& reflectance() const { return *reflectance_; }
  const LightSampling& light_sampling() const { return *light_sampling_; }

 private:
  luminaire::SharedSetting setting_;
  SharedReflectance reflectance_;
  SharedLightSampling light_sampling_;
};

using SharedTechniques = std::shared_ptr<const Techniques>;

}  // namespace assay::direct_light
