#pragma once

// How points of the luminaire are drawn, with their density in solid angle.

#include <memory>
#include <optional>

#include "estimators/parameters.h"
#include "estimators/stream.h"
#include "luminaire/family.h"

namespace assay::direct_light {

/// A point of the luminaire, seen from the receiver.
struct LightPoint {
  render::Vector3 to_light;
  double density = 0;  ///< per solid angle
};

class LightSampling {
 public:
  virtual ~LightSampling() = default;
  /// None where the point does not emit towards the receiver.
  virtual std::optional<LightPoint> sample(Stream& random) const = 0;
  /// The density per solid angle of the point of a triangle that emits towards the receiver in the
  /// direction of the unit vector w.
  virtual double density(const luminaire::LightTriangle&, const render::Vector3& w) const = 0;
};

using SharedLightSampling = std::shared_ptr<const LightSampling>;

/// Points uniform in area: density distance^2 / (area light_cosine).
SharedLightSampling area_sampling(luminaire::SharedSetting);
/// Directions uniform in the solid angle Omega of the triangles that emit towards the receiver
/// (Arvo 1995): density 1 / Omega.
SharedLightSampling solid_angle_sampling(luminaire::SharedSetting);

/// `light_sampling`: solid_angle or area.
ParameterInformation light_sampling_parameter();
SharedLightSampling read_light_sampling(Parameters&, luminaire::SharedSetting);

}  // namespace assay::direct_light
