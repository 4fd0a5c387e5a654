#include "harness/domain_chart.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace assay::harness {
namespace {

constexpr double pi = std::numbers::pi;

Point direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

template <Domain D>
std::array<double, 2> angles(const Point& p) {
  static const std::vector<Marginal> both = marginals(D);
  return {both[0].coordinate(p), both[1].coordinate(p)};
}

template <Domain D>
DomainChart of_directions(double highest_theta) {
  return {.first = {0, highest_theta},
          .second = {0, 2 * pi},
          .point = direction,
          .jacobian = [](double theta, double) { return std::sin(theta); },
          .coordinates = angles<D>};
}

DomainChart of_square() {
  return {.first = {0, 1},
          .second = {0, 1},
          .point =
              [](double u, double v) {
                return Point{u, v, 0};
              },
          .jacobian = [](double, double) { return 1.0; },
          .coordinates =
              [](const Point& p) {
                return std::array{p[0], p[1]};
              }};
}

// v as a share of what u leaves. Rounding of u + v <= 1 must not lead outside.
double share_of_rest(double v, double u) {
  const double rest = 1 - u;
  if (v <= rest) return rest > 0 ? v / rest : 0;
  return v <= rest * (1 + 1e-12) + 1e-16 ? 1 : v / rest;
}

DomainChart of_triangle() {
  return {.first = {0, 1},
          .second = {0, 1},
          .point =
              [](double u, double share) {
                return Point{u, share * (1 - u), 0};
              },
          .jacobian = [](double u, double) { return 1 - u; },
          .coordinates =
              [](const Point& p) {
                return std::array{p[0], share_of_rest(p[1], p[0])};
              }};
}

DomainChart turned(DomainChart chart, Domain domain) {
  std::swap(chart.first, chart.second);
  if (domain == Domain::triangle) {
    chart.point = [](double v, double share) { return Point{share * (1 - v), v, 0}; };
    chart.coordinates = [](const Point& p) { return std::array{p[1], share_of_rest(p[0], p[1])}; };
    return chart;  // the same element of area: 1 - v
  }
  if (domain == Domain::square) {
    chart.point = [](double v, double u) { return Point{u, v, 0}; };
    chart.coordinates = [](const Point& p) { return std::array{p[1], p[0]}; };
    return chart;
  }
  chart.point = [](double phi, double theta) { return direction(theta, phi); };
  chart.jacobian = [](double, double theta) { return std::sin(theta); };
  chart.coordinates = [](const Point& p) {
    const auto [theta, phi] = angles<Domain::sphere>(p);
    return std::array{phi, theta};
  };
  return chart;
}

// The first coordinate below which a share of the domain's measure lies.
double quantile(Domain domain, double share) {
  switch (domain) {
    case Domain::hemisphere:
      return std::acos(1 - share);
    case Domain::sphere:
      return std::acos(1 - 2 * share);
    case Domain::triangle:
      return 1 - std::sqrt(1 - share);
    case Domain::square:
    case Domain::interval:
      break;
  }
  return share;
}

std::vector<double> borders(stats::Span span, std::size_t cells, auto quantile) {
  std::vector<double> all{span.low};
  for (std::size_t k = 1; k < cells; ++k) {
    all.push_back(quantile(static_cast<double>(k) / static_cast<double>(cells)));
  }
  all.push_back(span.high);
  return all;
}

}  // namespace

DomainChart chart_by(Domain domain, std::size_t marginal) {
  const auto straight = [&] {
    switch (domain) {
      case Domain::hemisphere:
        return of_directions<Domain::hemisphere>(pi / 2);
      case Domain::sphere:
        return of_directions<Domain::sphere>(pi);
      case Domain::square:
        return of_square();
      case Domain::triangle:
        return of_triangle();
      case Domain::interval:
        break;
    }
    throw std::logic_error("an interval has one coordinate");
  };
  return marginal == 0 ? straight() : turned(straight(), domain);
}

stats::PlaneGrid equal_measure_grid(Domain domain, std::array<std::size_t, 2> cells) {
  const DomainChart chart = chart_by(domain, 0);
  const auto first = [&](double share) { return quantile(domain, share); };
  const auto second = [&](double share) { return share * chart.second.width(); };
  return {borders(chart.first, cells[0], first), borders(chart.second, cells[1], second)};
}

}  // namespace assay::harness
