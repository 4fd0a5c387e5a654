#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace assay::stats {

// Equal cells on [low, high]; index() of the upper end is the last cell. Throws std::domain_error
// outside the interval.
struct IntervalGrid {
  double low = 0;
  double high = 1;
  std::size_t cells = 64;

  std::size_t size() const { return cells; }
  std::size_t index(double x) const;
};

struct Direction {
  double cos_theta = 1;  // in [0, 1]
  double phi = 0;        // any angle in radians; taken modulo 2 pi
};

// Cells of equal solid angle on the upper hemisphere, cos theta x phi, phi running fastest.
struct HemisphereGrid {
  std::size_t cos_theta_cells = 16;
  std::size_t phi_cells = 32;

  std::size_t size() const { return cos_theta_cells * phi_cells; }
  std::size_t index(Direction direction) const;
};

struct CellProbabilities {
  std::vector<double> probability;
  std::vector<double> error;  // estimated absolute error of each
  double total = 0;           // sum of probability: 1 minus it is the mass of "no point"
  double total_error = 0;
};

struct QuadratureOptions {
  double tolerance = 1e-10;  // absolute, of each cell
  int deepest_bisection = 40;
};
// A jump along a curve costs 2^depth parts a cell.
inline constexpr QuadratureOptions hemisphere_quadrature{1e-10, 8};

// Integral of a density over every cell: a cell is halved (quartered on the hemisphere) until the
// parts agree with the whole to the tolerance or the depth is reached; the disagreement left is the
// error estimate. On the hemisphere the density is per unit solid angle, without a cosine. Throws
// std::domain_error when a density is negative or not finite. On an interval jumps may lie anywhere
// (AdaptiveQuadrature). On the hemisphere the estimate is blind to one nearer to the edge of a part
// than the outermost node (2.5 % of its width): let known jumps lie on cell edges.
CellProbabilities cell_probabilities(const IntervalGrid& grid,
                                     const std::function<double(double)>& density,
                                     QuadratureOptions options = {});
CellProbabilities cell_probabilities(const HemisphereGrid& grid,
                                     const std::function<double(Direction)>& density,
                                     QuadratureOptions options = hemisphere_quadrature);

}  // namespace assay::stats
