#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "estimators/parameters.h"
#include "estimators/stream.h"
#include "luminaire/exact.h"
#include "render/brdf.h"
#include "render/vector.h"

namespace assay::direct_light {

/// A number for each of the two techniques: sampling the light, sampling the BRDF.
struct Pair {
  double light = 0;
  double brdf = 0;
};

using render::Reflectance;
using SharedReflectance = std::shared_ptr<const Reflectance>;

/// Reads `brdf`: a map with one key, `lambert` (albedo), `ward` or `ashikhmin_shirley`, and under
/// it the parameters of that reflectance. InputError at the offending node for what is not such a
/// map, and whatever the reflectance refuses.
SharedReflectance read_reflectance(Parameters&);

/// A point of the luminaire, seen from the receiver.
struct LightPoint {
  render::Vector3 to_light;
  double density = 0;  ///< per solid angle
};

struct LightSampling {
  /// None where the point does not emit towards the receiver.
  std::function<std::optional<LightPoint>(Stream& random)> sample;
  /// The density per solid angle of the point of a triangle that emits towards the receiver in the
  /// direction of the unit vector w.
  std::function<double(const luminaire::LightTriangle&, const render::Vector3& w)> density;
};

/// Directions uniform in the solid angle Omega of the triangles that emit towards the receiver
/// (Arvo 1995): density 1 / Omega.
LightSampling solid_angle_sampling(luminaire::SharedSetting);

/// `light_sampling`: solid_angle or area.
LightSampling read_light_sampling(Parameters&, luminaire::SharedSetting);

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
             LightSampling light_sampling);
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
  const LightSampling& light_sampling() const { return light_sampling_; }

 private:
  luminaire::SharedSetting setting_;
  SharedReflectance reflectance_;
  LightSampling light_sampling_;
};

using SharedTechniques = std::shared_ptr<const Techniques>;

/// scene and brdf.
std::vector<ParameterInformation> common_parameters();
/// scene, brdf, light_sampling and `more`.
std::vector<ParameterInformation> parameters_with(std::vector<ParameterInformation> more);

/// Reads what parameters_with() declares; `Kind` is made as Techniques is.
template <class Kind = Techniques>
std::shared_ptr<const Kind> read_techniques(Parameters& given) {
  const luminaire::SharedSetting setting = luminaire::read_setting(given);
  const SharedReflectance reflectance = read_reflectance(given);
  return std::make_shared<const Kind>(setting, reflectance, read_light_sampling(given, setting));
}

}  // namespace assay::direct_light
