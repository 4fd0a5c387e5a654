#include "render/brdf/brdf_ashikhmin_shirley.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assay::render {

using std::numbers::pi;

double AshikhminShirley::normalisation() const {
  return std::sqrt((material_.exponents.u + 1) * (material_.exponents.v + 1));
}

// The power (n.h)^e of a unit half vector. Its logarithm, with s = sin^2 d, is
//   e ln cos d = (nu hx^2 + nv hy^2) ln(1 - s) / 2s.
// It is smooth at h = n, unlike the azimuth.
double AshikhminShirley::lobe(const Vector3& h) const {
  const double s = h.x * h.x + h.y * h.y;
  const double ratio = s > 0 ? std::log1p(-std::min(s, 1.0)) / s : -1;
  const Exponents& n = material_.exponents;
  return std::exp((n.u * h.x * h.x + n.v * h.y * h.y) * ratio / 2);
}

double AshikhminShirley::fresnel(double cosine) const {
  const double rest = 1 - cosine;
  const double squared = rest * rest;
  return material_.reflectance + (1 - material_.reflectance) * squared * squared * rest;
}

double AshikhminShirley::value(const Vector3& out) const {
  const Vector3 h = normalised(incident() + out);
  const double cosine = dot(h, incident());
  return normalisation() / (8 * pi) * lobe(h) * fresnel(cosine) /
         (cosine * std::max(incident().z, out.z));
}

double AshikhminShirley::first_quadrant(double u) const {
  const Exponents& n = material_.exponents;
  return std::atan2(std::sqrt(n.u + 1) * std::sin(pi / 2 * u),
                    std::sqrt(n.v + 1) * std::cos(pi / 2 * u));
}

double AshikhminShirley::azimuth(double u) const {
  const double quadrant = std::floor(4 * u);
  const double within = 4 * u - quadrant;
  if (quadrant == 0) return first_quadrant(within);
  if (quadrant == 1) return pi - first_quadrant(1 - within);
  if (quadrant == 2) return pi + first_quadrant(within);
  return 2 * pi - first_quadrant(1 - within);
}

double AshikhminShirley::exponent(double azimuth) const {
  const double x = std::cos(azimuth);
  const double y = std::sin(azimuth);
  return material_.exponents.u * x * x + material_.exponents.v * y * y;
}

double AshikhminShirley::squared_sine(double azimuth, double v) const {
  return -std::expm1(2 * std::log(v) / (exponent(azimuth) + 1));
}

double AshikhminShirley::half_vector_density(const Vector3& h) const {
  return normalisation() / (2 * pi) * lobe(h);
}

// With C = sqrt((nu+1)(nv+1)), c = cos d, 1 / q = 4 pi sqrt(cos_o), m = max(cos_i, cos_o):
//   Density:     p / q     = C c^(e+1) sqrt(cos_o) / (cos_i + cos_o)      <= C / (2 sqrt(cos_i)).
//   BRDF:        f / q     = C c^(e+1) F sqrt(cos_o) / ((cos_i + cos_o) m) <= C / (2 cos_i^1.5).
//   With cosine: f cos_o/q = C c^(e+1) F cos_o^1.5 / ((cos_i + cos_o) m)   <= C / (2 sqrt(cos_i)).
// Here cos_i + cos_o = 2 (h.w_i) c. Each function of cos_o is largest at cos_o = cos_i, and c <= 1,
// F <= 1, e >= 0.
double AshikhminShirley::rejection_bound(Target target) const {
  const double cosine = incident().z;
  const double largest = normalisation() / (2 * std::sqrt(cosine));
  return target == Target::brdf ? largest / cosine : largest;
}

double AshikhminShirley::width() const {
  return 1 / std::sqrt(std::max(material_.exponents.u, material_.exponents.v) + 1);
}

}  // namespace assay::render
