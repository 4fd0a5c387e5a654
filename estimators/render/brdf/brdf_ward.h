#pragma once

#include "render/brdf/brdf.h"

namespace assay::render {

/// Standard deviations of the surface slopes along x and y.
struct Roughness {
  double x = 0;
  double y = 0;
};

/// The anisotropic Gaussian reflectance of Ward (1992), eq. 5a, with reflectance 1:
///   f = exp(-tan^2 d (cos^2 phi / ax^2 + sin^2 phi / ay^2)) / (4 pi ax ay sqrt(cos_i cos_o)).
/// d and phi are the angles of h. f is unbounded where w_o grazes the surface. It is sampled after
/// Walter (2005), "Notes on the Ward BRDF", eqs. 6-9:
///   phi = atan((ay / ax) tan 2 pi u),  tan^2 d = -ln v / (cos^2 phi / ax^2 + sin^2 phi / ay^2),
///   p_h = exp(.) / (pi ax ay cos^3 d),  f cos_o / p = (h . w_i) cos^3 d sqrt(cos_o / cos_i).
/// Bounds are proved for ax, ay <= 1.
class Ward : public HalfVectorBrdf {
 public:
  Ward(Roughness roughness, Angles incident) : HalfVectorBrdf(incident), roughness_(roughness) {}

  double value(const Vector3& out) const override;
  double azimuth(double u) const override;
  double squared_sine(double azimuth, double v) const override;
  double half_vector_density(const Vector3& h) const override;
  double rejection_bound(Target) const override;
  double weight_bound() const override;
  double width() const override;

  const Roughness& roughness() const { return roughness_; }

 private:
  double gaussian(const Vector3& h) const;

  Roughness roughness_;
};

}  // namespace assay::render
