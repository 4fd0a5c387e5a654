#include "render/brdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "render/hemisphere.h"

namespace assay::render {

using std::numbers::pi;

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

Vector3 HalfVectorBrdf::sample(Stream& random) const {
  const double u = random.uniform();
  return reflected(half_vector(u, random.uniform_open()));
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

// The lobe of w_o is twice as wide as that of h, whose slopes have about this deviation at least.
double AshikhminShirley::width() const {
  return 2 / std::sqrt(std::max(material_.exponents.u, material_.exponents.v) + 1);
}

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

double Ward::width() const { return 2 * std::min(roughness_.x, roughness_.y); }

namespace {

// The bounds are attained, so that rounding can lift the quotient a few units in the last place
// above them.
constexpr double rounding = 1 + 0x1p-40;

Vector3 propose(Stream& random) {
  const double xi = random.uniform_open();
  const double cosine = xi * xi;
  const double sine = std::sqrt(1 - cosine * cosine);
  const auto [x, y] = on_unit_circle(random.uniform());
  return {sine * x, sine * y, cosine};
}

using Five = std::array<double, 5>;

constexpr double tolerance = 1e-12;

// In the half plane of h with azimuth phi, cos_o = R cos(2 theta - psi), theta the polar angle of
// h. R cos psi = cos_i and R sin psi = sin_i cos(phi - phi_i). At the `limit` theta = pi / 4 + psi
// / 2 w_o meets the horizon. The integrand of f has a root's singularity in cos_o there. With theta
// = limit - delta, cos_o = R sin 2 delta has no cancellation.
struct HalfPlane {
  double phi;
  double amplitude;
  double psi;

  HalfPlane(const Vector3& incident, double azimuth) : phi(azimuth) {
    const double along = incident.x * std::cos(phi) + incident.y * std::sin(phi);
    amplitude = std::hypot(incident.z, along);
    psi = std::atan2(along, incident.z);
  }
  double limit() const { return pi / 4 + psi / 2; }
};

// The five integrands at one half vector, times d w_o / (d delta d phi).
Five integrands(const HalfVectorBrdf& brdf, const HalfPlane& plane, double delta) {
  const Vector3 h = direction({.theta = plane.limit() - delta, .phi = plane.phi});
  Vector3 out = brdf.reflected(h);
  out.z = plane.amplitude * std::sin(2 * delta);
  const double measure = 4 * dot(h, brdf.incident()) * std::hypot(h.x, h.y);
  const double density = brdf.density(out);
  const double value = brdf.value(out);
  const double integrand = value * out.z;
  // If p underflows, so does f cos_o: their ratio is bounded.
  const double second = density > 0 ? integrand * integrand / density : 0;
  return {density * measure, value * measure, integrand * measure, integrand * out.z * measure,
          second * measure};
}

Integrals<5> over_polar_angle(const HalfVectorBrdf& brdf, const HalfPlane& plane) {
  const double limit = plane.limit();
  // delta = limit s^2 removes the singularity at the horizon.
  const auto integrand = [&](double s) {
    Five y = integrands(brdf, plane, limit * s * s);
    for (double& component : y) component *= 2 * limit * s;
    return y;
  };
  // At theta = psi, cos_o passes cos_i: a kink of max(cos_i, cos_o).
  std::array<double, 3> breaks{0, 1, 1};
  if (plane.psi > 0) breaks[1] = std::sqrt((limit - plane.psi) / limit);
  return tanh_sinh_pieces<5>(integrand, breaks, tolerance);
}

}  // namespace

Vector3 sample_by_rejection(const HalfVectorBrdf& brdf, Target target, Stream& random) {
  const double bound = brdf.rejection_bound(target);
  while (true) {
    const Vector3 out = propose(random);
    const double quotient = 4 * pi * std::sqrt(out.z) * brdf.target(target, out);
    const double acceptance = quotient / bound;
    if (!(acceptance <= rounding)) {
      std::ostringstream message;
      message << "sample_by_rejection: the target is " << acceptance << " times its bound at ("
              << out.x << ", " << out.y << ", " << out.z << ")";
      throw std::logic_error(message.str());
    }
    if (random.uniform() < acceptance) return out;
  }
}

BrdfIntegrals integrate(const HalfVectorBrdf& brdf) {
  const Vector3& incident = brdf.incident();
  Five inner_error{};
  const auto over_azimuth = [&](double phi) {
    const Integrals<5> inner = over_polar_angle(brdf, HalfPlane(incident, phi));
    for (std::size_t i = 0; i < 5; ++i) {
      inner_error[i] = std::max(inner_error[i], 2 * pi * inner.error[i]);
    }
    return inner.value;
  };
  // Breaks at the axes of the lobe, where it may be narrow, and across the plane of incidence,
  // where the kink appears.
  double across = std::atan2(incident.y, incident.x) + pi / 2;
  across -= pi * std::floor(across / pi);
  std::array<double, 7> breaks{0, pi / 2, pi, 3 * pi / 2, 2 * pi, across, across + pi};
  const Integrals<5> total = tanh_sinh_pieces<5>(over_azimuth, breaks, tolerance);

  const Five& v = total.value;
  double error = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    error = std::max(error, (total.error[i] + inner_error[i]) / v[i]);
  }
  return {v[0], v[1], v[2], v[3], v[4], error};
}

}  // namespace assay::render
