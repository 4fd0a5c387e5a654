#pragma once

// Anisotropic reflectances that are sampled through the half vector.

#include "render/vector.h"

namespace assay::render {

/// A direction by its polar and azimuthal angle, radians.
struct Angles {
  double theta = 0;
  double phi = 0;
};

Vector3 direction(Angles);

/// The function that a sampler of reflected directions may follow.
enum class Target {
  density,      ///< the density of the published sampler
  brdf,         ///< f
  brdf_cosine,  ///< f cos theta_o, the integrand of the albedo
};

/// A reflectance f(w_i, w_o) with w_i fixed, in the local frame (normal +z), and its published
/// sampler. The sampler draws an azimuth and a polar angle of the half vector h by inversion. It
/// mirrors w_i: w_o = 2 (h . w_i) h - w_i. The density is p(w_o) = p_h(h) / (4 h . w_i). It
/// integrates over the upper hemisphere to one minus the mass that falls below the horizon.
///
/// Each part is a virtual function, so that one can be exchanged while the others stay.
class HalfVectorBrdf {
 public:
  /// `incident` points away from the surface, above the horizon.
  explicit HalfVectorBrdf(Angles incident) : incident_(direction(incident)) {}
  virtual ~HalfVectorBrdf() = default;

  const Vector3& incident() const { return incident_; }

  /// f per steradian at w_o above the horizon.
  virtual double value(const Vector3& out) const = 0;

  /// The azimuth of h, from u uniform in [0, 1).
  virtual double azimuth(double u) const = 0;
  /// sin^2 of the polar angle of h given its azimuth, from v uniform in (0, 1).
  virtual double squared_sine(double azimuth, double v) const = 0;
  virtual Vector3 half_vector(double u, double v) const;
  /// The mirror image of w_i about h. Below the horizon (z <= 0) no direction came out.
  Vector3 reflected(const Vector3& h) const { return 2 * dot(h, incident_) * h - incident_; }

  /// p_h per steradian of h.
  virtual double half_vector_density(const Vector3& h) const = 0;
  /// d h / d w_o = 1 / (4 h . w_i).
  virtual double jacobian(const Vector3& h) const { return 1 / (4 * dot(h, incident_)); }
  /// p(w_o); 0 below the horizon.
  double density(const Vector3& out) const;

  /// The target per steradian, not normalised.
  double target(Target, const Vector3& out) const;

  /// An upper bound of target(w_o) / q(w_o) over the upper hemisphere. The proposal is q = 1 / (4
  /// pi sqrt(cos theta_o)), that is cos theta_o = xi^2. Each override has the proof.
  virtual double rejection_bound(Target) const = 0;
  /// An upper bound of f cos theta_o / p.
  virtual double weight_bound() const = 0;
  /// About the smallest standard deviation of the slope of h: the width of the lobe.
  virtual double width() const = 0;

 private:
  Vector3 incident_;
};

}  // namespace assay::render
