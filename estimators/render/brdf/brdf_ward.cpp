#include "render/brdf/brdf_ward.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assay::render {

using std::numbers::pi;

// exp(-tan^2 d (...)) of a half vector of any length.
double Ward::gaussian(const Vector3& h) const {
  const double x = h.x / (h.z * roughness_.x);
  const double y = h.y / (h.z * roughness_.y);
  return std::exp(-(x * x + y * y));
}

double Ward::value(const Vector3& out) const {
  return gaussian(incident() + out) /
         (4 * pi * roughness_.x * roughness_.y * std::sqrt(incident().z * out.z));
}

double Ward::azimuth(double u) const {
  // The two-argument arctangent is the published atan with its quadrant put right.
  return std::atan2(roughness_.y * std::sin(2 * pi * u), roughness_.x * std::cos(2 * pi * u));
}

double Ward::squared_sine(double azimuth, double v) const {
  const double x = std::cos(azimuth) / roughness_.x;
  const double y = std::sin(azimuth) / roughness_.y;
  const double squared_tangent = -std::log(v) / (x * x + y * y);
  return squared_tangent / (1 + squared_tangent);
}

double Ward::half_vector_density(const Vector3& h) const {
  return gaussian(h) / (pi * roughness_.x * roughness_.y * h.z * h.z * h.z);
}

// With t = tan^2 d, g = exp(-t A(phi)), 4 pi sqrt(cos_o) = 1 / q and K = 1 / (ax ay sqrt(cos_i)):
//   BRDF:        f / q       = K g                                          <= K.
//   BRDF cosine: f cos_o / q = K g cos_o                                    <= K.
//   Density:     p / q       = g sqrt(cos_o) / (ax ay (h . w_i) cos^3 d)    <= K.
// Proof of the last. It is 2 g sqrt(cos_o) (1 + t) / (ax ay (cos_i + cos_o)), since cos_i + cos_o =
// 2 (h . w_i) cos d. It is at most K g (1 + t), since 2 sqrt(cos_i cos_o) <= cos_i + cos_o. And A
// >= 1 / max(ax, ay)^2 >= 1 makes (1 + t) exp(-t A) <= 1.
double Ward::rejection_bound(Target) const {
  return 1 / (roughness_.x * roughness_.y * std::sqrt(incident().z));
}

double Ward::weight_bound() const { return 1 / std::sqrt(incident().z); }

double Ward::width() const { return std::min(roughness_.x, roughness_.y); }

}  // namespace assay::render
