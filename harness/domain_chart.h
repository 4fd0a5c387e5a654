#pragma once

// Coordinates of a sampler's domain in which a rectangle is all of it, so that cells and marginals
// of every domain are those of a rectangle.

#include <array>
#include <cstddef>
#include <vector>

#include "estimators/sampler.h"
#include "stats/plane_cells.h"

namespace assay::harness {

/// Hemisphere and sphere: theta and phi, density per solid angle times sin theta. Square: u and v.
/// Triangle: u and v / (1 - u), times 1 - u; by its second marginal v and u / (1 - v).
struct DomainChart {
  stats::Span first;
  stats::Span second;
  Point (*point)(double first, double second);
  double (*jacobian)(double first, double second);
  std::array<double, 2> (*coordinates)(const Point&);
};

/// The chart whose first coordinate is the marginal of this number, 0 or 1. Not for intervals.
DomainChart chart_by(Domain domain, std::size_t marginal);

/// Cells of equal measure (solid angle, area) in the chart by the first marginal.
stats::PlaneGrid equal_measure_grid(Domain domain, std::array<std::size_t, 2> cells);

}  // namespace assay::harness
