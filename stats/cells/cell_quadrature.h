#pragma once

#include <cstddef>

#include "stats/basics/adaptive_quadrature.h"

namespace assay::stats {

// A density per dx dy on a rectangle, and how finely it must be looked at: no feature of it lies
// between the nodes of these many equal panels, and jumps along lines of a coordinate lie on their
// borders.
struct PlaneDensity {
  Span x;
  Span y;
  PlaneValues values;
  std::size_t x_panels = 1;
  std::size_t y_panels = 1;
};

// A function of one place as one of many.
template <class Density>
PlaneValues point_by_point(Density density) {
  return [density](std::span<const double> x, std::span<const double> y, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = density(x[i], y[i]);
  };
}

// The density at x, integrated over part of the other coordinate. `density` must outlive it.
AdaptiveQuadrature::Function across(const PlaneDensity& density, Span y, AdaptiveQuadrature& rule);

// The density of x alone: integrated over all of y.
inline AdaptiveQuadrature::Function marginal_density(const PlaneDensity& density,
                                                     AdaptiveQuadrature& rule) {
  return across(density, density.y, rule);
}

// A rectangle of two coordinates.
struct PlaneCell {
  Span x;
  Span y;
};

// Integrates a density over one rectangle after another, all within the limits together: along y
// within x, each adaptively, so that a jump along any curve is a border that bisection finds in y
// and at most a kink in x. `tolerance` is that of each inner and each outer part. Throws
// std::domain_error where the density is negative or not finite.
class CellQuadrature {
 public:
  // Keeps a reference to the density.
  CellQuadrature(const PlaneDensity& density, QuadratureLimits limits)
      : density_(density), rule_(limits) {}

  Integral over(const PlaneCell& cell);
  // Of a cell in which over() met no density, next to one in which it did: looks for it along the
  // sides, at 256 points each. What may still hide there is not part of the error.
  Integral beside_support(const PlaneCell& cell);
  double densest() const { return densest_; }                 // of all met so far
  double densest_of_last() const { return rule_.largest(); }  // in the last cell asked for
  bool exhausted() const { return rule_.exhausted(); }

 private:
  bool shown_at(const PlaneCell& cell, std::size_t first);
  bool shown_at_a_side(const PlaneCell& cell);

  const PlaneDensity& density_;
  AdaptiveQuadrature rule_;
  double densest_ = 0;
};

// The mass that a support may hide from beside_support() in a cell: a corner of half a step squared
// between the points, as dense as what was met next to it.
double hidden_beside_support(const PlaneCell& cell, double densest);

}  // namespace assay::stats
