#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "stats/cells/plane_cells.h"

namespace assay::stats {

// The cells of a grid, some of them halved, and some of their halves again: together they are the
// grid. They are numbered in the order of the grid's, the parts of one behind one another, the
// lower half first, so that neighbours in number are neighbours in place.
struct HalvedCells {
  // A cell that was halved. A part is the number of another such cell, or of a cell that is whole.
  struct Part {
    bool whole = true;
    std::size_t number = 0;
  };
  struct Halves {
    bool along_x = true;
    double border = 0;  // what lies on it is in the upper half
    std::array<Part, 2> parts = {};
  };

  PlaneGrid grid;
  std::vector<Part> parts;  // each of the grid's cells
  std::vector<Halves> halves;
  std::vector<PlaneCell> cells;         // those that are whole
  std::vector<std::size_t> grid_cells;  // the number of the grid's cell that each is part of

  std::size_t size() const { return cells.size(); }
  // Throws std::domain_error outside the grid.
  std::size_t index(double x, double y) const;
};

// None is halved. Throws std::domain_error where borders do not ascend.
HalvedCells whole_cells(const PlaneGrid& grid);

}  // namespace assay::stats
