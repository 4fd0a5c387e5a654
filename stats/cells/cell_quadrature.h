#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "stats/basics/adaptive_quadrature.h"

namespace assay::stats {

// A density per dx dy on a rectangle. The panels say how finely it must be looked at. No feature
// lies between the nodes of that many equal panels. Jumps along lines of a coordinate lie on their
// borders.
struct PlaneDensity {
  Span x;
  Span y;
  PlaneValues values;
  Panelling x_panels = {};
  Panelling y_panels = {};
  std::vector<std::array<double, 2>> drawn = {};  // Values of the law, which show its peaks.
};

// The density at x, integrated over part of the other coordinate. `density` must outlive the
// result.
AdaptiveQuadrature::Function across(const PlaneDensity& density, Span y, AdaptiveQuadrature& rule);

// The density of x alone: integrated over all of y.
inline AdaptiveQuadrature::Function marginal_density(const PlaneDensity& density,
                                                     AdaptiveQuadrature& rule) {
  return across(density, density.y, rule);
}

struct PlaneCell {
  Span x;
  Span y;
};

// Integrates a density over one rectangle after another, all within the limits together. It
// integrates adaptively along y within x. So a jump along any curve is a border in y, which
// bisection finds. In x it is at most a kink. The tolerance applies to each inner and each outer
// part. Throws std::domain_error where the density is negative or not finite.
class CellQuadrature {
 public:
  // Keeps a reference to the density.
  CellQuadrature(const PlaneDensity& density, QuadratureLimits limits)
      : density_(density), rule_(limits) {}

  Integral over(const PlaneCell& cell);
  // For a cell in which over() met no density, next to one in which it did. It looks for density
  // along the sides, at 256 points each. The error does not cover what may still hide there.
  Integral beside_support(const PlaneCell& cell);
  double densest() const { return densest_; }                 // Largest density so far.
  double densest_of_last() const { return rule_.largest(); }  // Largest in the last cell.
  bool exhausted() const { return rule_.exhausted(); }

 private:
  Integral over(const PlaneDensity& density, const PlaneCell& cell);
  bool shown_at(const PlaneCell& cell, std::size_t first);
  bool shown_at_a_side(const PlaneCell& cell);

  const PlaneDensity& density_;
  AdaptiveQuadrature rule_;
  double densest_ = 0;
};

// The mass that a support may hide from beside_support() in a cell. The hidden corner is half the
// squared step between the points, as dense as what was met next to it.
double hidden_beside_support(const PlaneCell& cell, double densest);

}  // namespace assay::stats
