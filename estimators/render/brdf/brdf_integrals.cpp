#include "render/brdf/brdf_integrals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace assay::render {

namespace {

using std::numbers::pi;
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
