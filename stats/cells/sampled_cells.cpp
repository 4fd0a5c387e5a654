#include "stats/cells/sampled_cells.h"

#include <algorithm>
#include <span>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"

namespace assay::stats {
namespace {

using Points = std::span<PlanePoint>;

/// Borders that cut sorted values into about equal parts. None is the smallest value, and none
/// occurs twice.
std::vector<double> borders(Points sorted, std::size_t parts, double PlanePoint::*coordinate) {
  std::vector<double> all;
  double last = sorted.front().*coordinate;
  for (std::size_t k = 1; k < parts; ++k) {
    const double value = sorted[k * sorted.size() / parts].*coordinate;
    if (value > last) all.push_back(value);
    last = value;
  }
  return all;
}

}  // namespace

std::size_t SampledCells::index(PlanePoint point) const {
  const std::size_t band = count_up_to(band_borders, point.first);
  return before[band] + count_up_to(cut_borders[band], point.second);
}

SampledCells sampled_cells(std::vector<PlanePoint> points, CellNumbers numbers) {
  check::at_least({"sampled_cells", "points"}, points.size(), 1);
  check::at_least({"sampled_cells", "bands"}, numbers.bands, 1);
  check::at_least({"sampled_cells", "cuts"}, numbers.cuts, 1);
  for (const PlanePoint& point : points) {
    check::finite({"sampled_cells", "first coordinate"}, point.first);
    check::finite({"sampled_cells", "second coordinate"}, point.second);
  }
  std::ranges::sort(points, {}, &PlanePoint::first);
  SampledCells cells{.band_borders = borders(points, numbers.bands, &PlanePoint::first)};
  std::size_t behind = 0;
  auto begin = points.begin();
  for (std::size_t band = 0; band <= cells.band_borders.size(); ++band) {
    const auto end = band == cells.band_borders.size()
                         ? points.end()
                         : std::ranges::lower_bound(begin, points.end(), cells.band_borders[band],
                                                    {}, &PlanePoint::first);
    std::ranges::sort(begin, end, {}, &PlanePoint::second);
    cells.cut_borders.push_back(borders(Points(begin, end), numbers.cuts, &PlanePoint::second));
    cells.before.push_back(behind);
    behind += cells.cut_borders.back().size() + 1;
    begin = end;
  }
  return cells;
}

}  // namespace assay::stats
