#pragma once

// How a surface reflects light from a direction towards a fixed viewer, and how directions are
// drawn for it.

#include <memory>
#include <optional>

#include "estimators/parameters.h"
#include "estimators/stream.h"
#include "render/vector.h"

namespace assay::direct_light {

/// A BRDF f(w, viewer) with the viewer fixed and the directions w in the receiver's frame, +z up.
class Reflectance {
 public:
  virtual ~Reflectance() = default;

  /// f per steradian at w above the horizon.
  virtual double value(const render::Vector3& w) const = 0;
  /// A direction of density(w) per solid angle; below the horizon (z <= 0) none came out.
  virtual render::Vector3 sample(Stream& random) const = 0;
  virtual double density(const render::Vector3& w) const = 0;
  /// An upper bound of f cos / density.
  virtual double weight_bound() const = 0;
  /// About the angle across a lobe.
  virtual double width() const = 0;
  /// f where it is the same for all directions.
  virtual std::optional<double> constant() const { return {}; }
};

using SharedReflectance = std::shared_ptr<const Reflectance>;

/// The parameter `brdf`: a map with one key, `lambert` (albedo), `ward` or `ashikhmin_shirley`, and
/// under it the parameters of that reflectance.
ParameterInformation brdf_parameter();
/// InputError at the offending node for what is not such a map, and whatever the reflectance
/// refuses.
SharedReflectance read_reflectance(Parameters&);

}  // namespace assay::direct_light
