#pragma once

// Anisotropic reflectances that are sampled through the half vector.

#include <optional>

#include "estimators/stream.h"
#include "render/quadrature.h"
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

/// A BRDF f(w, viewer) with the viewer fixed and the directions w in the receiver's frame, +z up.
class Reflectance {
 public:
  virtual ~Reflectance() = default;

  /// f per steradian at w above the horizon.
  virtual double value(const Vector3& w) const = 0;
  /// A direction of density(w) per solid angle; below the horizon (z <= 0) none came out.
  virtual Vector3 sample(Stream& random) const = 0;
  virtual double density(const Vector3& w) const = 0;
  /// An upper bound of f cos / density.
  virtual double weight_bound() const = 0;
  /// About the angle across a lobe.
  virtual double width() const = 0;
  /// f where it is the same for all directions.
  virtual std::optional<double> constant() const { return {}; }
};

/// A reflectance f(w_i, w_o) with w_i fixed, in the local frame (normal +z), and its published
/// sampler. The sampler draws an azimuth and a polar angle of the half vector h by inversion. It
/// mirrors w_i: w_o = 2 (h . w_i) h - w_i. The density is p(w_o) = p_h(h) / (4 h . w_i). It
/// integrates over the upper hemisphere to one minus the mass that falls below the horizon.
///
/// Each part is a virtual function, so that one can be exchanged while the others stay.
class HalfVectorBrdf : public Reflectance {
 public:
  /// `incident` points away from the surface, above the horizon.
  explicit HalfVectorBrdf(Angles incident) : incident_(direction(incident)) {}

  const Vector3& incident() const { return incident_; }

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
  double density(const Vector3& out) const override;
  Vector3 sample(Stream& random) const override;

  /// The target per steradian, not normalised.
  double target(Target, const Vector3& out) const;

  /// An upper bound of target(w_o) / q(w_o) over the upper hemisphere. The proposal is q = 1 / (4
  /// pi sqrt(cos theta_o)), that is cos theta_o = xi^2. Each override has the proof.
  virtual double rejection_bound(Target) const = 0;

 private:
  Vector3 incident_;
};

/// Phong-like exponents along x and y.
struct Exponents {
  double u = 0;
  double v = 0;
};

/// The specular part of the anisotropic Phong reflectance of Ashikhmin & Shirley (2000), eq. 4:
///  `f = sqrt((nu+1)(nv+1)) / (8 pi) (n.h)^e F(h.w_i) / ((h.w_i) max(cos_i, cos_o)),
///   e = nu cos^2 phi + nv sin^2 phi,  F(c) = R + (1 - R)(1 - c)^5  (Schlick)`.
/// It is sampled by their eqs. 9-10: cos d = v^(1/(e+1)), and in the first quadrant phi =
/// atan(sqrt((nu+1)/(nv+1)) tan(pi u'/2)), mirrored to the others. So
///  `p_h = sqrt((nu+1)(nv+1)) / (2 pi) (n.h)^e  and  f cos_o / p = F cos_o / max(cos_i, cos_o)`.
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

/// Standard deviations of the surface slopes along x and y.
struct Roughness {
  double x = 0;
  double y = 0;
};

/// The anisotropic Gaussian reflectance of Ward (1992), eq. 5a, with reflectance 1:
///  `f = exp(-tan^2 d (cos^2 phi / ax^2 + sin^2 phi / ay^2)) / (4 pi ax ay sqrt(cos_i cos_o))`.
/// Here d and phi are the angles of h. This f is unbounded where w_o grazes the surface. It is
/// sampled after Walter (2005), "Notes on the Ward BRDF", eqs. 6-9:
///  `phi = atan((ay / ax) tan 2 pi u),  tan^2 d = -ln v / (cos^2 phi / ax^2 + sin^2 phi / ay^2),
///   p_h = exp(.) / (pi ax ay cos^3 d),  f cos_o / p = (h . w_i) cos^3 d sqrt(cos_o / cos_i)`.
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

/// A direction of the upper hemisphere with density proportional to a target of the reflectance. It
/// rejects from the proposal cos theta_o = xi^2, q = 1 / (4 pi sqrt(cos theta_o)): Ward's f grows
/// like 1 / sqrt(cos theta_o), so a uniform proposal would be wrong. It redraws until it accepts.
/// That is the algorithm, so no mass is missing. std::logic_error if the target exceeds the
/// reflectance's `rejection_bound` by more than rounding.
Vector3 sample_by_rejection(const HalfVectorBrdf&, Target, Stream&);

/// Integrals over the upper hemisphere of w_o.
struct BrdfIntegrals {
  double mass = 0;           ///< Integral of p: one minus the mass below the horizon.
  double brdf = 0;           ///< Integral of f.
  double albedo = 0;         ///< Integral of f cos_o, the directional albedo.
  double cosine_moment = 0;  ///< Integral of f cos_o^2.
  double second_moment = 0;  ///< Integral of (f cos_o)^2 / p.
  double error = 0;          ///< Largest relative error of the five, estimated.
};

/// By quadrature in the angles of the half vector, where the lobe sits at the pole and the horizon
/// of w_o is a known curve. Relative errors are about 1e-11.
BrdfIntegrals integrate(const HalfVectorBrdf&);

}  // namespace assay::render
