#pragma once

#include <cstddef>
#include <vector>

namespace assay::stats {

// A value of two coordinates; of one coordinate the second is 0.
struct PlanePoint {
  double first = 0;
  double second = 0;
};

// Cells of the whole plane: bands of the first coordinate, each cut along the second. Only borders
// between cells are kept, so the outermost cells have no end. A value on a border is in the upper
// cell.
struct SampledCells {
  std::vector<double> band_borders;              // Ascending, one fewer than bands.
  std::vector<std::vector<double>> cut_borders;  // One vector per band.
  std::vector<std::size_t> before;               // Number of cells in the bands before each.

  std::size_t size() const { return before.back() + cut_borders.back().size() + 1; }
  std::size_t index(PlanePoint point) const;
};

struct CellNumbers {
  std::size_t bands = 16;
  std::size_t cuts = 16;  // Number in each band.
};

// Cells that hold about as many of the points each. Borders are quantiles of the first coordinate,
// then of the second within each band. If values repeat there are fewer cells. Throws
// std::domain_error: no points, values not finite, numbers of 0.
SampledCells sampled_cells(std::vector<PlanePoint> points, CellNumbers numbers);

}  // namespace assay::stats
