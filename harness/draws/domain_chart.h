#pragma once

// Maps a sampler's domain to a rectangle, so that cells and marginals of all domains are those of a
// rectangle.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "estimators/sampler.h"
#include "stats/cells/plane_cells.h"

namespace assay::harness {

/// A coordinate's value; for an angle also sine and cosine.
struct Coordinate {
  double value;
  double cosine = 0;
  double sine = 0;
};

/// Hemisphere and sphere: theta and phi, density per solid angle times sin theta. Square: u and v.
/// Triangle: u and v / (1 - u), times 1 - u; by its second marginal v and u / (1 - v).
struct DomainChart {
  stats::Span first;
  stats::Span second;
  Coordinate (*coordinate)(double value);
  Point (*point)(const Coordinate& first, const Coordinate& second);
  double (*jacobian)(const Coordinate& first, const Coordinate& second);
  std::array<double, 2> (*coordinates)(const Point&);
};

/// A cache of coordinates: quadrature meets the same values in every row of cells, and sine and
/// cosine cost more than most densities. Each slot remembers the latest value.
class RememberedCoordinates {
 public:
  explicit RememberedCoordinates(Coordinate (*coordinate)(double)) : coordinate_(coordinate) {}

  const Coordinate& operator()(double value) {
    Coordinate& known = table_[place_of(value)];
    if (known.value != value) known = coordinate_(value);
    return known;
  }

 private:
  static constexpr int bits = 12;

  static std::size_t place_of(double value) {
    // Knuth's multiplicative hashing by the golden ratio.
    return (std::bit_cast<std::uint64_t>(value) * 0x9E3779B97F4A7C15) >> (64 - bits);
  }

  Coordinate (*coordinate_)(double);
  std::vector<Coordinate> table_ = std::vector<Coordinate>(
      std::size_t{1} << bits, {.value = std::numeric_limits<double>::quiet_NaN()});
};

/// The chart whose first coordinate is this marginal, 0 or 1. Not for intervals.
DomainChart chart_by(Domain domain, std::size_t marginal);

/// Cells in the chart by the first marginal. These shares of the measure (solid angle, area) lie
/// below their borders.
stats::PlaneGrid grid_between(Domain domain, std::span<const double> first,
                              std::span<const double> second);

}  // namespace assay::harness
