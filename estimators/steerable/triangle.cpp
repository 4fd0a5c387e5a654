#include "steerable/triangle.h"

#include <cmath>

#include "estimators/core/mapped.h"
#include "estimators/core/value.h"
#include "estimators/estimator.h"

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

VertexWeights read_weights(Parameters& given) {
  const Value& list = given.structure("weights");
  given.require(list.items().size() == 3, "weights", "must be a list of three numbers");
  const VertexWeights weights{at_least_zero(list.items()[0], "a number of `weights`"),
                              at_least_zero(list.items()[1], "a number of `weights`"),
                              at_least_zero(list.items()[2], "a number of `weights`")};
  given.require(weights.sum() != 0, "weights", "must not all be zero");
  return weights;
}

// Integrals over the triangle of products of its coordinates (Dirichlet). The density is 6 sum w_j
// l_j / W. E[l_i] = (W + w_i) / (4 W), and E[l_i^2] = (W + 2 w_i) / (10 W).
std::vector<Channel> triangle_channels(const VertexWeights& weights, bool with_variance) {
  const std::array<double, 3> w = {weights.a, weights.b, weights.c};
  const std::array<const char*, 3> names = {"a", "b", "c"};
  return mapped_indices(w.size(), [&](std::size_t i) {
    const double mean = (weights.sum() + w[i]) / (4 * weights.sum());
    const double square = (weights.sum() + 2 * w[i]) / (10 * weights.sum());
    Channel channel{.name = names[i], .mean = mean};
    if (with_variance) channel.variance = square - mean * mean;
    return channel;
  });
}

}  // namespace assay::steerable

namespace assay::plugins {

std::vector<Entry> steerable_triangle() {
  return {
      {{.name = "steerable/triangle",
        .summary = "Points of a triangle with a density linear between given vertex weights.",
        .description =
            "Channels a, b and c: the barycentric coordinates of a point of density "
            "proportional to the interpolated weights. Means (W + w_i) / (4 W), W the sum of "
            "the weights; second moments (W + 2 w_i) / (10 W). Samplers: `point` (u, v the "
            "coordinates of b and c), and `square`, the pair of numbers behind a point, of "
            "constant density.",
        .parameters = {structure_parameter(
            "weights", "at the vertices a, b and c: none negative, not all zero", "[1, 2, 5]")}},
       [](Parameters& given) {
         return steerable::triangle_setup<steerable::LinearTriangle>(steerable::read_weights(given),
                                                                     true);
       }}};
}

}  // namespace assay::plugins
