#include "harness/draws/declared_density.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "estimators/core/mapped.h"

namespace assay::harness {
namespace {

// More panels of both coordinates together would exceed the limits of the quadrature.
constexpr std::size_t most_panels = std::size_t{1} << 15;

Densities checked(const NamedSampler& named, Densities densities) {
  return [&named, densities](std::span<const Point> points, std::span<double> out) {
    const std::size_t written = densities(points, out);
    for (std::size_t i = 0; i < written; ++i) sound_density(named, points[i], out[i]);
    return written;
  };
}

class OnChart {
 public:
  OnChart(const DomainChart& chart, Densities densities)
      : chart_(chart), densities_(std::move(densities)), firsts_(chart), seconds_(chart) {}

  void operator()(std::span<const double> x, std::span<const double> y, std::span<double> values) {
    points_.clear();
    jacobians_.clear();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Coordinate& first = firsts_(x[i]);
      const Coordinate& second = seconds_(y[i]);
      points_.push_back(chart_.point(first, second));
      jacobians_.push_back(chart_.jacobian(first, second));
    }
    write_all(densities_, points_, values);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= jacobians_[i];
  }

 private:
  DomainChart chart_;
  Densities densities_;
  RememberedCoordinates firsts_;
  RememberedCoordinates seconds_;
  std::vector<Point> points_;
  std::vector<double> jacobians_;
};

// Cells at a jump of the density are right to 1e-6 together. A million draws tell 1e-4 of a cell,
// so more digits would cost time for nothing.
constexpr stats::QuadratureLimits limits{.tolerance = 1e-8};

// More cells of a peak find finer defects, but need more points for those that are everywhere
// (tests/cells_study.sh). A share of 1/32 would be one column of azimuths of a lobe about
// the pole.
constexpr double largest_share = 1.0 / 40;

stats::AdaptiveCells cells_of_lobe(const NamedSampler& named, const stats::PlaneGrid& grid,
                                   std::span<const Point> drawn, int lobe) {
  const Sampler& sampler = *named.sampler;
  const auto of_lobe = [&named, lobe](std::span<const Point> points, std::span<double> out) {
    return named.sampler->lobe_densities(lobe, points, out);
  };
  const Densities densities = checked(named, of_lobe);
  // A grid's own cells must not all be halved if they are slightly above the mean.
  const double share = std::max(largest_share, 2 / static_cast<double>(grid.size()));
  if (sampler.domain() == Domain::interval) {
    return stats::adaptive_cells(grid.x_borders, line_density(sampler, drawn, densities), share,
                                 limits);
  }
  return stats::adaptive_cells(grid, plane_density(sampler, 0, drawn, densities), share, limits);
}

void append(stats::CellProbabilities& all, const stats::CellProbabilities& more) {
  all.probability.insert(all.probability.end(), more.probability.begin(), more.probability.end());
  all.error.insert(all.error.end(), more.error.begin(), more.error.end());
  all.total += more.total;
  all.total_error += more.total_error;
}

}  // namespace

void write_all(const Densities& densities, std::span<const Point> points, std::span<double> out) {
  for (std::size_t done = 0; done < points.size();) {
    done += densities(points.subspan(done), out.subspan(done));
  }
}

Densities densities_of(const NamedSampler& named) {
  return checked(named, [&named](std::span<const Point> points, std::span<double> out) {
    return named.sampler->densities(points, out);
  });
}

stats::LineDensity line_density(const Sampler& sampler, std::span<const Point> drawn,
                                Densities densities) {
  const auto values = [densities = std::move(densities)](std::span<const double> x,
                                                         std::span<double> out) {
    write_all(densities, mapped(x, [](double each) { return Point{each, 0, 0}; }), out);
  };
  std::vector<double> places = mapped(drawn, [](const Point& point) { return point[0]; });
  const stats::Span whole{sampler.bounds()[0], sampler.bounds()[1]};
  return {.values = values,
          .panels = {.equal = sampler.panels().first,
                     .borders = stats::borders_of_peaks(std::move(places), whole)}};
}

bool is_impossible(const Sampler& sampler, const Point& point, double density) {
  if (density != 0) return false;
  constexpr double least_reach = 1e-6;
  const double reach = std::max(least_reach, sampler.rounding());
  const auto moved = [&](double place, const stats::Span& span, int steps) {
    return std::clamp(place + steps * reach * span.width(), span.low, span.high);
  };
  if (sampler.domain() == Domain::interval) {
    const stats::Span span{sampler.bounds()[0], sampler.bounds()[1]};
    return std::ranges::all_of(std::array{-1, 1}, [&](int steps) {
      return sampler.density({moved(point[0], span, steps), 0, 0}) == 0;
    });
  }
  const DomainChart chart = chart_by(sampler.domain(), 0);
  const auto [first, second] = chart.coordinates(point);
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const Point beside = chart.point(chart.coordinate(moved(first, chart.first, i)),
                                       chart.coordinate(moved(second, chart.second, j)));
      if (sampler.density(beside) != 0) return false;
    }
  }
  return true;
}

stats::PlaneDensity plane_density(const Sampler& sampler, std::size_t marginal,
                                  std::span<const Point> drawn, Densities densities) {
  const DomainChart chart = chart_by(sampler.domain(), marginal);
  Panels panels = sampler.panels();
  while (panels.first * panels.second > most_panels) {
    std::size_t& larger = panels.first > panels.second ? panels.first : panels.second;
    larger = (larger + 1) / 2;
  }
  std::vector<std::array<double, 2>> at;
  std::array<std::vector<double>, 2> places;
  for (const Point& point : drawn) {
    at.push_back(chart.coordinates(point));
    for (std::size_t i = 0; i < 2; ++i) places[i].push_back(at.back()[i]);
  }
  return {.x = chart.first,
          .y = chart.second,
          .values = OnChart(chart, std::move(densities)),
          .x_panels = {.equal = marginal == 0 ? panels.first : panels.second,
                       .borders = stats::borders_of_peaks(std::move(places[0]), chart.first)},
          .y_panels = {.equal = marginal == 0 ? panels.second : panels.first,
                       .borders = stats::borders_of_peaks(std::move(places[1]), chart.second)},
          .drawn = std::move(at)};
}

double DensityCells::tolerance() const {
  const double parts = static_cast<double>(cells.size()) + 10;
  return 8 * mass.total_error + parts * std::numeric_limits<double>::epsilon() * mass.total;
}

std::vector<std::uint64_t> DensityCells::in_cells(std::span<const std::uint64_t> counts) const {
  std::vector<std::uint64_t> all(counts.begin(), counts.begin() + std::ssize(impossible(counts)));
  std::ranges::transform(all, impossible(counts), all.begin(), std::plus());
  return all;
}

double DensityCells::missing() const {
  const double rest = 1 - mass.total;
  return rest <= tolerance() ? 0 : rest;
}

DensityCells density_cells(const NamedSampler& named, StreamKey key, std::span<const Point> drawn) {
  const Sampler& sampler = *named.sampler;
  const stats::PlaneGrid grid = shifted_grid(sampler, key);
  std::vector<stats::HalvedCells> of_lobes;
  stats::CellProbabilities mass;
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe) {
    stats::AdaptiveCells found = cells_of_lobe(named, grid, drawn, lobe);
    append(mass, found.mass);
    of_lobes.push_back(std::move(found.cells));
  }
  double point_masses = 0;
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe) {
    const double point_mass = sampler.point_mass(lobe);
    if (point_mass == 0) continue;
    append(mass, {.probability = {point_mass}, .error = {0}, .total = point_mass});
    point_masses += point_mass;
  }
  return {.cells = DrawCells(sampler, std::move(of_lobes)),
          .mass = std::move(mass),
          .point_masses = point_masses};
}

}  // namespace assay::harness
