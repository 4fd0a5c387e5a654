#include "render/brdf/brdf.h"

#include <cmath>

namespace assay::render {

Vector3 direction(Angles angles) {
  const double sine = std::sin(angles.theta);
  return {sine * std::cos(angles.phi), sine * std::sin(angles.phi), std::cos(angles.theta)};
}

Vector3 HalfVectorBrdf::half_vector(double u, double v) const {
  const double phi = azimuth(u);
  const double squared = squared_sine(phi, v);
  const double sine = std::sqrt(squared);
  return {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1 - squared)};
}

double HalfVectorBrdf::density(const Vector3& out) const {
  if (out.z <= 0) return 0;
  const Vector3 h = normalised(incident_ + out);
  return half_vector_density(h) * jacobian(h);
}

double HalfVectorBrdf::target(Target target, const Vector3& out) const {
  switch (target) {
    case Target::density:
      return density(out);
    case Target::brdf:
      return value(out);
    case Target::brdf_cosine:
      return value(out) * out.z;
  }
  return 0;
}

}  // namespace assay::render
