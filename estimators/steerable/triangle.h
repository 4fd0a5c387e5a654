#pragma once

// Points of a triangle with a density that is linear in it: warp, samplers and estimator.

#include <memory>
#include <vector>

#include "estimators/estimator.h"

namespace assay::steerable {

/// Values at the vertices a, b and c, none negative and not all zero.
struct VertexWeights {
  double a = 0;
  double b = 0;
  double c = 0;

  double sum() const { return a + b + c; }
};

/// The point (1 - u - v) A + u B + v C.
struct TrianglePoint {
  double u = 0;
  double v = 0;

  double weight(const VertexWeights& w) const { return (1 - u - v) * w.a + u * w.b + v * w.c; }
};

/// Maps the unit square to the triangle with density 6 weight / sum per unit of du dv (Subr and
/// Arvo 2007, "Steerable importance sampling"). With u = s (1 - t), v = s t it solves a cubic for
/// s, then a quadratic for t:
///  `s^2 (3 a (1 - 2 s / 3) + (b + c) s) / (a + b + c) = x,
///   gamma t^2 + rho t = y,  gamma = s (c - b) / T,  rho = 2 ((1 - s) a + s b) / T,
///   T = s (c - b) + 2 ((1 - s) a + s b)`.
struct LinearTriangle {
  TrianglePoint operator()(const VertexWeights& weights, double x, double y) const;
};

/// The cubic's root in [0, 1], by Newton's method kept between bounds.
double linear_distance(const VertexWeights& weights, double x);

/// The (x, y) that LinearTriangle maps to a point.
struct SquarePoint {
  double x = 0;
  double y = 0;
};
SquarePoint square_of(const VertexWeights& weights, const TrianglePoint& point);

/// InputError at `weights` unless they are three numbers, none negative, of positive sum.
VertexWeights read_weights(Parameters&);
/// The coordinates a, b, c; mean, and variance too if the estimator is the sound one.
std::vector<Channel> triangle_channels(const VertexWeights&, bool with_variance);

/// Samplers: the points, of density 6 weight / sum, and the pairs of numbers behind them, uniform.
template <class Warp>
std::shared_ptr<const Setup> triangle_setup(const VertexWeights& weights, bool sound) {
  const auto draw = [weights](Stream& random) {
    const double x = random.uniform();
    return Warp{}(weights, x, random.uniform());
  };
  const auto estimate = [draw](Stream& random, std::uint64_t primaries, std::span<double> out,
                               Cost& cost) {
    double sum_u = 0;
    double sum_v = 0;
    for (std::uint64_t i = 0; i < primaries; ++i) {
      const auto [u, v] = draw(random);
      sum_u += u;
      sum_v += v;
    }
    const auto n = static_cast<double>(primaries);
    out[0] = 1 - (sum_u + sum_v) / n;
    out[1] = sum_u / n;
    out[2] = sum_v / n;
    cost.samples += primaries;
  };
  const auto point = [draw](Stream& random) {
    const auto [u, v] = draw(random);
    return Point{u, v, 0};
  };
  const auto density = [weights](const Point& p) {
    return 6 * TrianglePoint{p[0], p[1]}.weight(weights) / weights.sum();
  };
  const auto square = [draw, weights](Stream& random) {
    const auto [x, y] = square_of(weights, draw(random));
    return Point{x, y, 0};
  };
  return setup_of(
      {.channels = triangle_channels(weights, sound),
       .make = estimating(estimate),
       .samplers = {{"point", sampler_of({Domain::triangle, point, density})},
                    {"square", sampler_of({Domain::square, square, uniform_density(1)})}}});
}

}  // namespace assay::steerable
