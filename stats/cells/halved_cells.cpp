#include "stats/cells/halved_cells.h"

namespace assay::stats {

std::size_t HalvedCells::index(double x, double y) const {
  Part part = parts[grid.index(x, y)];
  while (!part.whole) {
    const Halves& two = halves[part.number];
    part = two.parts[(two.along_x ? x : y) < two.border ? 0 : 1];
  }
  return part.number;
}

HalvedCells whole_cells(const PlaneGrid& grid) {
  check_borders(grid);
  HalvedCells all{.grid = grid};
  for (std::size_t i = 0; i < grid.size(); ++i) {
    all.parts.push_back({.whole = true, .number = i});
    all.cells.push_back(grid.cell(i));
    all.grid_cells.push_back(i);
  }
  return all;
}

}  // namespace assay::stats
