#include "steerable/linear_triangle.h"

#include <cmath>

namespace assay::steerable {

namespace {

// The share of the triangle's weight within s of vertex a.
double share(const VertexWeights& w, double s) {
  return s * s * (3 * w.a - 2 * s * w.a + s * (w.b + w.c)) / w.sum();
}

}  // namespace

double linear_distance(const VertexWeights& w, double x) {
  double low = 0;
  double high = 1;
  double s = std::sqrt(x);
  for (int step = 0; step < 60; ++step) {
    const double excess = share(w, s) - x;
    (excess > 0 ? high : low) = s;
    const double slope = 3 * s * (2 * w.a * (1 - s) + s * (w.b + w.c)) / w.sum();
    double next = s - excess / slope;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::abs(next - s) <= 0x1p-52 * s) return next;
    s = next;
  }
  return s;
}

TrianglePoint LinearTriangle::operator()(const VertexWeights& w, double x, double y) const {
  const double s = linear_distance(w, x);
  const double near = 2 * ((1 - s) * w.a + s * w.b);
  const double difference = s * (w.c - w.b);
  const double total = near + difference;
  if (!(total > 0)) return {0, 0};  // s = 0: the vertex itself
  const double rho = near / total;
  const double gamma = difference / total;
  const double root = rho + std::sqrt(rho * rho + 4 * gamma * y);
  const double t = root > 0 ? 2 * y / root : 0;
  return {s * (1 - t), s * t};
}

SquarePoint square_of(const VertexWeights& w, const TrianglePoint& point) {
  const double s = point.u + point.v;
  if (s <= 0) return {};
  const double t = point.v / s;
  const double near = 2 * ((1 - s) * w.a + s * w.b);
  const double difference = s * (w.c - w.b);
  return {share(w, s), t * (near + difference * t) / (near + difference)};
}

}  // namespace assay::steerable
