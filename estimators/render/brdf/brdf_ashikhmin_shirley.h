#pragma once

#include "render/brdf/brdf.h"

namespace assay::render {

/// Phong-like exponents along x and y.
struct Exponents {
  double u = 0;
  double v = 0;
};

/// The specular part of the anisotropic Phong reflectance of Ashikhmin & Shirley (2000), eq. 4:
///   f = sqrt((nu+1)(nv+1)) / (8 pi) (n.h)^e F(h.w_i) / ((h.w_i) max(cos_i, cos_o)),
///   e = nu cos^2 phi + nv sin^2 phi,  F(c) = R + (1 - R)(1 - c)^5  (Schlick).
/// It is sampled by their eqs. 9-10: cos d = v^(1/(e+1)), and in the first quadrant phi =
/// atan(sqrt((nu+1)/(nv+1)) tan(pi u'/2)), mirrored to the others. So
///   p_h = sqrt((nu+1)(nv+1)) / (2 pi) (n.h)^e  and  f cos_o / p = F cos_o / max(cos_i, cos_o).
class AshikhminShirley : public HalfVectorBrdf {
 public:
  struct Material {
    Exponents exponents;
    double reflectance = 1;  ///< R, at normal incidence
  };

  AshikhminShirley(Material material, Angles incident)
      : HalfVectorBrdf(incident), material_(material) {}

  double value(const Vector3& out) const override;
  double azimuth(double u) const override;
  double squared_sine(double azimuth, double v) const override;
  double half_vector_density(const Vector3& h) const override;
  double rejection_bound(Target) const override;
  double weight_bound() const override { return 1; }
  double width() const override;

 protected:
  /// The azimuth in [0, pi/2] from u uniform in [0, 1].
  double first_quadrant(double u) const;
  /// e at an azimuth.
  double exponent(double azimuth) const;

 private:
  double normalisation() const;
  double lobe(const Vector3& h) const;
  double fresnel(double cosine) const;

  Material material_;
};

}  // namespace assay::render
