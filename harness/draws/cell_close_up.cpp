#include "harness/draws/cell_close_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace assay::harness {
namespace {

constexpr std::size_t points_a_side = 64;
constexpr double largest_part = 1.0 / 8;

double area(const stats::PlaneCell& cell) { return cell.x.width() * cell.y.width(); }

stats::Span around(const stats::Span& a, const stats::Span& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

std::vector<stats::PlaneCell> heavy_cells(const DensityCells& density) {
  const std::span mass = std::span(density.mass.probability).first(density.cells.in_domain());
  const double least = *std::ranges::max_element(mass) / 2;
  std::vector<stats::PlaneCell> cells;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (mass[i] >= least) cells.push_back(density.cells.sides(i));
  }
  return cells;
}

/// The shortest arc of a circle that holds all spans; it may end beyond 2 pi.
stats::Span arc_around(std::vector<stats::Span> spans, const stats::Span& circle) {
  std::ranges::sort(spans, {}, &stats::Span::low);
  double end = spans.back().high - circle.width();
  double widest = 0;
  stats::Span arc;
  for (const stats::Span& span : spans) {
    if (span.low - end >= widest) {
      widest = span.low - end;
      // The arc is the circle without its largest gap.
      arc = {span.low, end + circle.width()};
    }
    end = std::max(end, span.high);
  }
  return arc;
}

bool goes_round(Domain domain) { return domain == Domain::hemisphere || domain == Domain::sphere; }

stats::PlaneCell around_all(const std::vector<stats::PlaneCell>& cells, bool round,
                            const stats::Span& second) {
  stats::PlaneCell box = cells.front();
  std::vector<stats::Span> spans;
  for (const stats::PlaneCell& cell : cells) {
    box = {around(box.x, cell.x), around(box.y, cell.y)};
    spans.push_back(cell.y);
  }
  if (round) box.y = arc_around(std::move(spans), second);
  return box;
}

double place(const stats::Span& span, std::size_t point) {
  const double share = (static_cast<double>(point) + 0.5) / static_cast<double>(points_a_side);
  return span.low + share * span.width();
}

double farthest(std::span<const std::size_t> cells, std::span<const std::optional<double>> z) {
  double most = 0;
  for (const std::size_t cell : cells) {
    const double here = z[cell].value_or(0);
    if (std::abs(here) > std::abs(most)) most = here;
  }
  return most;
}

}  // namespace

std::optional<CloseUp> close_up(const DensityCells& density, const Sampler& sampler,
                                std::span<const std::optional<double>> z) {
  const stats::PlaneGrid& grid = density.cells.grid();
  const stats::PlaneCell domain{{grid.x_borders.front(), grid.x_borders.back()},
                                {grid.y_borders.front(), grid.y_borders.back()}};
  const stats::PlaneCell box =
      around_all(heavy_cells(density), goes_round(sampler.domain()), domain.y);
  if (area(box) >= largest_part * area(domain)) return std::nullopt;
  const std::vector<Marginal> coordinates = cell_coordinates(sampler);
  CloseUp shown{.axes = fmt::format("{} from top to bottom, {} from left to right",
                                    range_text(coordinates[0].name, box.x),
                                    range_text(coordinates[1].name, box.y)),
                .side = points_a_side};
  for (std::size_t row = 0; row < points_a_side; ++row) {
    for (std::size_t column = 0; column < points_a_side; ++column) {
      double y = place(box.y, column);
      if (y > domain.y.high) y -= domain.y.width();
      shown.z.push_back(farthest(density.cells.at(place(box.x, row), y), z));
    }
  }
  const bool empty = std::ranges::all_of(shown.z, [](double here) { return here == 0; });
  return empty ? std::nullopt : std::optional(shown);
}

}  // namespace assay::harness
