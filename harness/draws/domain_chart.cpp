#include "harness/draws/domain_chart.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace assay::harness {
namespace {

constexpr double pi = std::numbers::pi;

Coordinate number(double value) { return {.value = value}; }

Coordinate angle(double value) {
  return {.value = value, .cosine = std::cos(value), .sine = std::sin(value)};
}

Point direction(const Coordinate& theta, const Coordinate& phi) {
  return {theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine};
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
          .coordinate = angle,
          .point = direction,
          .jacobian = [](const Coordinate& theta, const Coordinate&) { return theta.sine; },
          .coordinates = angles<D>};
}

DomainChart of_square() {
  return {.first = {0, 1},
          .second = {0, 1},
          .coordinate = number,
          .point =
              [](const Coordinate& u, const Coordinate& v) {
                return Point{u.value, v.value, 0};
              },
          .jacobian = [](const Coordinate&, const Coordinate&) { return 1.0; },
          .coordinates =
              [](const Point& p) {
                return std::array{p[0], p[1]};
              }};
}

// v / (1 - u); 1 if rounding led to u + v > 1.
double share_of_rest(double v, double u) {
  const double rest = 1 - u;
  if (v > rest) return 1;
  return rest > 0 ? v / rest : 0;
}

DomainChart of_triangle() {
  return {.first = {0, 1},
          .second = {0, 1},
          .coordinate = number,
          .point =
              [](const Coordinate& u, const Coordinate& share) {
                return Point{u.value, share.value * (1 - u.value), 0};
              },
          .jacobian = [](const Coordinate& u, const Coordinate&) { return 1 - u.value; },
          .coordinates =
              [](const Point& p) {
                return std::array{p[0], share_of_rest(p[1], p[0])};
              }};
}

DomainChart turned(DomainChart chart, Domain domain) {
  std::swap(chart.first, chart.second);
  if (domain == Domain::triangle) {
    chart.point = [](const Coordinate& v, const Coordinate& share) {
      return Point{share.value * (1 - v.value), v.value, 0};
    };
    chart.coordinates = [](const Point& p) { return std::array{p[1], share_of_rest(p[0], p[1])}; };
    return chart;  // area element as for the first: 1 - v
  }
  if (domain == Domain::square) {
    chart.point = [](const Coordinate& v, const Coordinate& u) {
      return Point{u.value, v.value, 0};
    };
    chart.coordinates = [](const Point& p) { return std::array{p[1], p[0]}; };
    return chart;
  }
  chart.point = [](const Coordinate& phi, const Coordinate& theta) {
    return direction(theta, phi);
  };
  chart.jacobian = [](const Coordinate&, const Coordinate& theta) { return theta.sine; };
  chart.coordinates = [](const Point& p) {
    const auto [theta, phi] = angles<Domain::sphere>(p);
    return std::array{phi, theta};
  };
  return chart;
}

// The first coordinate below which this share of the domain's measure lies.
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

std::vector<double> borders(stats::Span span, std::span<const double> shares, auto quantile) {
  std::vector<double> all{span.low};
  for (const double share : shares) all.push_back(quantile(share));
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

stats::PlaneGrid grid_between(Domain domain, std::span<const double> first,
                              std::span<const double> second) {
  const DomainChart chart = chart_by(domain, 0);
  const auto below = [&](double share) { return quantile(domain, share); };
  const auto beside = [&](double share) { return share * chart.second.width(); };
  return {borders(chart.first, first, below), borders(chart.second, second, beside)};
}

}  // namespace assay::harness
