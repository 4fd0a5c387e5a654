#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/adaptive_quadrature.h"
#include "stats/cells.h"

namespace assay::stats {

// Cells between lines of two coordinates (a square's; a hemisphere's polar angle and azimuth), the
// second running fastest. Borders ascend strictly.
struct PlaneGrid {
  std::vector<double> x_borders;
  std::vector<double> y_borders;

  std::size_t size() const { return (x_borders.size() - 1) * (y_borders.size() - 1); }
  // A cell is closed below and open above, the last one closed. Throws std::domain_error outside
  // the grid.
  std::size_t index(double x, double y) const;
};

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
PlaneValues one_by_one(Density density) {
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

// Integral of the density over every cell: along y within x, each adaptively, so that a jump along
// any curve is a border that bisection finds in y and at most a kink in x. `tolerance` is that of
// each inner and each outer part. A cell in which the density was zero at every node, next to one
// in which it was not, is searched along its sides at 256 points each; what a support may still
// hide there, a corner of half a step squared, counts as its error. Throws std::domain_error when a
// density is negative or not finite.
CellProbabilities cell_probabilities(const PlaneGrid& grid, const PlaneDensity& density,
                                     QuadratureLimits limits = {.tolerance = 1e-9});

}  // namespace assay::stats
