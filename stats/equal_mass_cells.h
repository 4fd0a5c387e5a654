#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "stats/cells.h"
#include "stats/chi_square_fit.h"

namespace assay::stats {

// A point of the unit square. Other domains are its images under maps of constant Jacobian: a
// density per unit of their measure, times the measure, is the density on the square.
//   triangle:   a = s^2, (1 - s, s (1 - b), s b) barycentric; measure = area
//   hemisphere: cos theta = a, phi = 2 pi b;                  measure = 2 pi
//   sphere:     cos theta = 2 a - 1, phi = 2 pi b;            measure = 4 pi
struct SquarePoint {
  double a = 0;
  double b = 0;
};
struct Barycentric {
  double first = 1;
  double second = 0;
  double third = 0;
};
Barycentric triangle_point(SquarePoint point);
SquarePoint square_point(Barycentric point);

struct CellPlan {
  std::uint64_t observations = 1000;
  double minimum_expected = 20;
  std::size_t most_cells = 1024;
  std::size_t resolution = 64;  // cell edges lie on a grid of this many lines each way
};

// Cells of about equal probability, each with an expected count of at least minimum_expected,
// chosen from the density alone and never from the data: bands of a, cut along b, every edge on the
// lines of the grid. A density that is concentrated in few squares of the grid gives fewer, heavier
// cells.
struct EqualMassCells {
  std::vector<double> band_edges;              // from 0 to 1
  std::vector<std::vector<double>> cut_edges;  // of each band, from 0 to 1
  // total and total_error say whether the density integrates to 1.
  CellProbabilities cells;

  std::size_t size() const { return cells.probability.size(); }
  // Throws std::domain_error outside the unit square.
  std::size_t index(SquarePoint point) const;
};

// Throws std::domain_error: no observation, a negative or non-finite density, no mass.
EqualMassCells equal_mass_cells(const std::function<double(SquarePoint)>& density,
                                const CellPlan& plan,
                                QuadratureOptions options = hemisphere_quadrature);

// The same on an interval: edges on those of `fine` (whose number of cells replaces the
// resolution).
struct EqualMassIntervals {
  std::vector<double> edges;
  CellProbabilities cells;

  std::size_t size() const { return cells.probability.size(); }
  std::size_t index(double x) const;
};
EqualMassIntervals equal_mass_intervals(const std::function<double(double)>& density,
                                        const IntervalGrid& fine, const CellPlan& plan,
                                        QuadratureOptions options = {});

// Null hypothesis: the counts follow probabilities that lie within their errors of these. Every
// deviation |O - E| is lessened by n error, every expectation raised by it: a lower bound of X2
// over all such probabilities, so p is an upper bound of theirs. The mass 1 - total, where it
// exceeds total_error, is a last cell of points that were not generated, `missing` of them.
struct CellObservations {
  std::vector<std::uint64_t> observed;
  std::uint64_t missing = 0;
};
ChiSquareFit chi_square_fit(const CellProbabilities& cells, const CellObservations& counts,
                            double minimum_expected = 20);

}  // namespace assay::stats
