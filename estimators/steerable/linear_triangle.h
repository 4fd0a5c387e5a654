#pragma once

// Points of a triangle with a density that is linear in it.

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
///   s^2 (3 a (1 - 2 s / 3) + (b + c) s) / (a + b + c) = x,
///   gamma t^2 + rho t = y,  gamma = s (c - b) / T,  rho = 2 ((1 - s) a + s b) / T,
///   T = s (c - b) + 2 ((1 - s) a + s b).
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

}  // namespace assay::steerable
