#include "stats/equal_mass_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "stats/check.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// Ends of consecutive groups whose masses reach `least`; a short last group joins the one before.
std::vector<std::size_t> groups(std::span<const double> mass, double least) {
  std::vector<std::size_t> ends;
  double sum = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    sum += mass[i];
    if (sum < least) continue;
    ends.push_back(i + 1);
    sum = 0;
  }
  if (ends.empty()) ends.push_back(mass.size());
  ends.back() = mass.size();
  return ends;
}

double line(std::size_t i, std::size_t resolution) {
  return static_cast<double>(i) / static_cast<double>(resolution);
}

std::size_t cell_of(const std::vector<double>& edges, double x) {
  const auto after = std::upper_bound(edges.begin(), edges.end() - 1, x);
  return static_cast<std::size_t>(after - edges.begin()) - 1;
}

// Sums of the fine squares of one band over its rows.
CellProbabilities columns(const CellProbabilities& fine, std::size_t resolution, std::size_t from,
                          std::size_t to) {
  CellProbabilities sums;
  sums.probability.assign(resolution, 0);
  sums.error.assign(resolution, 0);
  for (std::size_t row = from; row < to; ++row) {
    for (std::size_t column = 0; column < resolution; ++column) {
      sums.probability[column] += fine.probability[row * resolution + column];
      sums.error[column] += fine.error[row * resolution + column];
    }
  }
  return sums;
}

double least_mass(const CellPlan& plan, double total) {
  check::at_least({"equal_mass_cells", "observations"}, plan.observations, 1);
  check::at_least({"equal_mass_cells", "most_cells"}, plan.most_cells, 1);
  check::positive({"equal_mass_cells", "minimum_expected"}, plan.minimum_expected);
  check::positive({"equal_mass_cells", "total mass"}, total);
  return std::max(plan.minimum_expected / static_cast<double>(plan.observations),
                  total / static_cast<double>(plan.most_cells));
}

// Sums of consecutive cells up to these ends.
void append_sums(CellProbabilities& result, const CellProbabilities& fine,
                 const std::vector<std::size_t>& ends) {
  std::size_t from = 0;
  for (const std::size_t to : ends) {
    double mass = 0;
    double error = 0;
    for (std::size_t i = from; i < to; ++i) {
      mass += fine.probability[i];
      error += fine.error[i];
    }
    result.probability.push_back(mass);
    result.error.push_back(error);
    from = to;
  }
}

}  // namespace

Barycentric triangle_point(SquarePoint point) {
  check::unit({"triangle_point", "a"}, point.a);
  check::unit({"triangle_point", "b"}, point.b);
  const double s = std::sqrt(point.a);
  return {1 - s, s * (1 - point.b), s * point.b};
}

SquarePoint square_point(Barycentric point) {
  const double s = point.second + point.third;
  check::unit({"square_point", "second + third"}, s);
  check::non_negative({"square_point", "third"}, point.third);
  return {s * s, s == 0 ? 0 : point.third / s};
}

std::size_t EqualMassCells::index(SquarePoint point) const {
  check::unit({"EqualMassCells::index", "a"}, point.a);
  check::unit({"EqualMassCells::index", "b"}, point.b);
  const std::size_t band = std::min(cell_of(band_edges, point.a), cut_edges.size() - 1);
  std::size_t before = 0;
  for (std::size_t i = 0; i < band; ++i) before += cut_edges[i].size() - 1;
  const auto& cuts = cut_edges[band];
  return before + std::min(cell_of(cuts, point.b), cuts.size() - 2);
}

EqualMassCells equal_mass_cells(const std::function<double(SquarePoint)>& density,
                                const CellPlan& plan, QuadratureOptions options) {
  check::at_least({"equal_mass_cells", "resolution"}, plan.resolution, 1);
  // The square as a hemisphere of measure 2 pi: the same quadrature.
  const auto as_direction = [&](Direction direction) {
    return density({direction.cos_theta, direction.phi / two_pi}) / two_pi;
  };
  const std::size_t m = plan.resolution;
  const CellProbabilities fine = cell_probabilities(HemisphereGrid{m, m}, as_direction, options);
  const double least = least_mass(plan, fine.total);
  std::vector<double> rows(m, 0);
  for (std::size_t i = 0; i < fine.probability.size(); ++i) rows[i / m] += fine.probability[i];
  EqualMassCells result;
  result.band_edges.push_back(0);
  std::size_t start = 0;
  for (const std::size_t end : groups(rows, std::max(least, std::sqrt(least * fine.total)))) {
    const CellProbabilities band = columns(fine, m, start, end);
    std::vector<double> cuts{0};
    const std::vector<std::size_t> ends = groups(band.probability, least);
    append_sums(result.cells, band, ends);
    for (const std::size_t to : ends) cuts.push_back(line(to, m));
    result.cut_edges.push_back(cuts);
    result.band_edges.push_back(line(end, m));
    start = end;
  }
  result.cells.total = fine.total;
  result.cells.total_error = fine.total_error;
  return result;
}

std::size_t EqualMassIntervals::index(double x) const {
  if (!(x >= edges.front() && x <= edges.back())) {
    check::fail({"EqualMassIntervals::index", "x"}, x, "inside the interval");
  }
  return std::min(cell_of(edges, x), size() - 1);
}

EqualMassIntervals equal_mass_intervals(const std::function<double(double)>& density,
                                        const IntervalGrid& fine, const CellPlan& plan,
                                        QuadratureOptions options) {
  const CellProbabilities parts = cell_probabilities(fine, density, options);
  const std::vector<std::size_t> ends = groups(parts.probability, least_mass(plan, parts.total));
  EqualMassIntervals result;
  append_sums(result.cells, parts, ends);
  result.edges.push_back(fine.low);
  for (const std::size_t end : ends) {
    const double share = line(end, fine.cells);
    result.edges.push_back(end == fine.cells ? fine.high
                                             : fine.low + (fine.high - fine.low) * share);
  }
  result.cells.total = parts.total;
  result.cells.total_error = parts.total_error;
  return result;
}

ChiSquareFit chi_square_fit(const CellProbabilities& cells, const CellObservations& counts,
                            double minimum_expected) {
  CellCounts full{counts.observed, cells.probability, cells.error};
  const double missing = 1 - cells.total;
  if (missing > cells.total_error || counts.missing > 0) {
    full.observed.push_back(counts.missing);
    full.probability.push_back(std::max(0.0, missing));
    full.error.push_back(cells.total_error);
  }
  return chi_square_fit(full, {minimum_expected, cells.total_error + 1e-9});
}

}  // namespace assay::stats
