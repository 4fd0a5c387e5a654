#include "stats/basics/adaptive_quadrature.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"

namespace assay::stats {
namespace {

constexpr std::size_t nodes = AdaptiveQuadrature::nodes;
using Rule = boost::math::quadrature::gauss<double, nodes>;

// Share of a part that lies beyond the outermost node, on one side.
constexpr double blind_share = 0.0255;

// The ends of a part are looked at this far inside, in units of its width. So borders of panels lie
// outside, rounding included.
constexpr double nudge = 1e-9;
// A jump of J in a part makes its halves err by up to .105 J times the width. The polynomials
// through their nodes depart from the density at the ends. That departure times blind_share may be
// as little as a ninth of the error.
constexpr double jump_share = 9 * blind_share;
// Halving leaves a part at 0 next to a pole x^-a however deep. There the rule misses less than this
// multiple of its result, up to a = .94. The density at the end tells nothing of it.
constexpr double most_of_a_pole = 16;
constexpr std::size_t low_end = nodes;
constexpr std::size_t high_end = low_end + 1;

// Numbers of all nodes, in their order, from those of the nodes at or above 0.
std::array<double, nodes> on_both_sides(const auto& upper, double sign) {
  std::array<double, nodes> all{upper[0]};
  for (std::size_t i = 1; i < upper.size(); ++i) {
    all[2 * i - 1] = sign * upper[i];
    all[2 * i] = upper[i];
  }
  return all;
}

// The nodes in [-1, 1].
const std::array<double, nodes>& node_places() {
  static const auto places = on_both_sides(Rule::abscissa(), -1);
  return places;
}

const std::array<double, nodes>& node_weights() {
  static const auto weights = on_both_sides(Rule::weights(), 1);
  return weights;
}

AdaptiveQuadrature::Places places_in(Span span) {
  AdaptiveQuadrature::Places places;
  const double half = span.width() / 2;
  std::transform(node_places().begin(), node_places().end(), places.begin(),
                 [&](double node) { return span.middle() + half * node; });
  places[low_end] = span.low + nudge * span.width();
  places[high_end] = span.high - nudge * span.width();
  return places;
}

// Weights of the values at the nodes for the polynomial's value at the part's lower end. The nodes
// lie symmetrically, so those at t stand for -t at the upper end.
const std::array<double, nodes>& weights_at_end() {
  static const std::array<double, nodes> weights = [] {
    const auto& t = node_places();
    std::array<double, nodes> all{};
    for (std::size_t i = 0; i < t.size(); ++i) {
      all[i] = 1;
      for (std::size_t j = 0; j < t.size(); ++j) {
        if (j != i) all[i] *= (-1 - t[j]) / (t[i] - t[j]);
      }
    }
    return all;
  }();
  return weights;
}

// How far the density at both ends departs from the polynomial, as it does with a jump.
double departure_at_ends(const AdaptiveQuadrature::Values& at) {
  double low = at[low_end].value - weights_at_end()[0] * at[0].value;
  double high = at[high_end].value - weights_at_end()[0] * at[0].value;
  for (std::size_t i = 1; i < nodes; i += 2) {
    const double near = weights_at_end()[i];
    const double far = weights_at_end()[i + 1];
    low -= near * at[i].value + far * at[i + 1].value;
    high -= far * at[i].value + near * at[i + 1].value;
  }
  return std::abs(low) + std::abs(high);
}

AdaptiveQuadrature::Sampled sampled_in(Span span, const AdaptiveQuadrature::Values& at) {
  AdaptiveQuadrature::Sampled found{.departure_at_ends = departure_at_ends(at)};
  for (std::size_t i = 0; i < nodes; ++i) {
    const double weight = span.width() / 2 * node_weights()[i];
    found.parts[i] = weight * at[i].value;
    found.integral =
        found.integral + Integral{found.parts[i], weight * at[i].error, weight * at[i].error};
  }
  // Mass that a jump may add or take, also beyond the outermost nodes, which neither a part nor its
  // halves see.
  found.integral.error += jump_share * span.width() * found.departure_at_ends;
  return found;
}

/// The sum of two halves. Its error is at least theirs, and at least its distance from the whole
/// part's integral.
Integral from_halves(Integral whole, Integral one, Integral two) {
  const Integral sum = one + two;
  return {sum.value, std::max(std::abs(sum.value - whole.value), sum.error), sum.given};
}

bool is_good(const Integral& sum, double tolerance) { return sum.error - sum.given <= tolerance; }

/// The integral of a part that is halved no further although its error is above the tolerance.
Integral given_up(Integral sum) {
  if (sum.value > 0) sum.error = std::min(sum.error, sum.given + most_of_a_pole * sum.value);
  return sum;
}

// Borders from `from` on toward `to`, in gaps that double, up to the middle between them.
void grade(double from, double to, double gap, std::vector<double>& borders) {
  const double sign = to > from ? 1 : -1;
  const double reach = std::abs(to - from) / 2;
  double distance = 0;
  while (distance + 2 * gap < reach) {
    gap *= 2;
    distance += gap;
    borders.push_back(from + sign * distance);
  }
}

}  // namespace

// The integrals along lines without halving, whose places are asked for together.
std::vector<Integral> AdaptiveQuadrature::whole(const PlaneValues& density,
                                                std::span<const Line> lines) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Line& line : lines) {
    const Places at = places_in(line.y);
    x.insert(x.end(), at.size(), line.x);
    y.insert(y.end(), at.begin(), at.end());
  }
  std::vector<double> densities(y.size());
  density(x, y, densities);
  std::vector<Integral> integrals;
  for (std::span<const double> rest = densities; const Line& line : lines) {
    integrals.push_back(sampled_in(line.y, counted(rest.first<nodes + 2>())).integral);
    rest = rest.subspan(nodes + 2);
  }
  return integrals;
}

AdaptiveQuadrature::Values AdaptiveQuadrature::counted(
    std::span<const double, nodes + 2> densities) {
  Values values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double density = densities[i];
    if (!(density >= 0 && density <= std::numeric_limits<double>::max())) {
      check::non_negative({"AdaptiveQuadrature", "density"}, density);
    }
    largest_ = std::max(largest_, density);
    values[i] = {density, 0};
  }
  used_ += values.size();
  return values;
}

AdaptiveQuadrature::Sampled AdaptiveQuadrature::sampled(const Function& function, Span span) {
  return sampled_in(span, function(places_in(span)));
}

// The integrals along lines, of which `whole` has those without halving.
std::vector<Integral> AdaptiveQuadrature::refined(const Wholes& whole,
                                                  std::span<const Line> lines) {
  struct Part {
    Line line;
    Integral whole;          // By its own nodes.
    Integral integral = {};  // The sum over its two halves, halved again or not.
    std::size_t halves = 0;  // Index of the first half, behind its part; 0 if there is none.
  };
  constexpr std::size_t most_of_a_level = std::size_t{1} << 20;
  const std::vector<Integral> wholes = whole(lines);
  std::vector<Part> parts;
  for (const Line& line : lines) parts.push_back({line, wholes[parts.size()]});
  std::size_t next = 0;
  for (int depth = deepest_bisection; next < parts.size(); --depth) {
    const std::size_t last = parts.size();
    std::vector<Line> halves;
    for (std::size_t i = next; i < last; ++i) {
      for (const Span& half : parts[i].line.y.halves()) halves.push_back({parts[i].line.x, half});
    }
    // A density that is rough everywhere would be halved without end.
    const std::size_t places = (nodes + 2) * halves.size();
    const bool ended =
        depth == 0 || places > most_of_a_level || used_ + places >= limits_.evaluations;
    const std::vector<Integral> found = whole(halves);
    for (std::size_t one = 0; next < last; ++next, one += 2) {
      Integral& sum = parts[next].integral;
      sum = from_halves(parts[next].whole, found[one], found[one + 1]);
      if (is_good(sum, limits_.tolerance)) continue;
      if (ended) {
        sum = given_up(sum);
        continue;
      }
      parts[next].halves = parts.size();
      parts.push_back({halves[one], found[one]});
      parts.push_back({halves[one + 1], found[one + 1]});
    }
  }
  for (std::size_t i = parts.size(); i-- > 0;) {
    const std::size_t halves = parts[i].halves;
    if (halves > 0) parts[i].integral = parts[halves].integral + parts[halves + 1].integral;
  }
  std::vector<Integral> integrals;
  for (const Part& part : std::span(parts).first(lines.size())) integrals.push_back(part.integral);
  return integrals;
}

Integral AdaptiveQuadrature::over(const Function& function, Span span) {
  const Line line{0, span};
  const auto whole = [&](std::span<const Line> parts) {
    std::vector<Integral> integrals;
    for (const Line& part : parts) integrals.push_back(sampled(function, part.y).integral);
    return integrals;
  };
  return refined(whole, {&line, 1})[0];
}

std::vector<Integral> AdaptiveQuadrature::along(const PlaneValues& density,
                                                std::span<const Line> lines) {
  return refined([&](std::span<const Line> parts) { return whole(density, parts); }, lines);
}

std::vector<Span> cut(Span span, Span whole, const Panelling& panels) {
  const double slack = 1e-12 * whole.width();
  const auto is_inside = [&](double border) {
    return border > span.low + slack && border < span.high - slack;
  };
  std::vector<double> borders;
  std::ranges::copy_if(panels.borders, std::back_inserter(borders), is_inside);
  const double width = whole.width() / static_cast<double>(panels.equal);
  for (std::size_t k = 1; k < panels.equal; ++k) {
    const double border = whole.low + width * static_cast<double>(k);
    if (is_inside(border)) borders.push_back(border);
  }
  std::ranges::sort(borders);
  std::vector<Span> parts;
  double low = span.low;
  for (const double border : borders) {
    if (border <= low + slack) continue;
    parts.push_back({low, border});
    low = border;
  }
  parts.push_back({low, span.high});
  return parts;
}

namespace {

constexpr std::size_t quantiles = 32;

std::vector<double> quantiles_of(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  std::vector<double> all;
  for (std::size_t k = 0; k <= quantiles; ++k) {
    const double value = sorted[k * (sorted.size() - 1) / quantiles];
    if (all.empty() || value > all.back()) all.push_back(value);
  }
  return all;
}

}  // namespace

std::vector<double> borders_of_peaks(std::span<const double> values, Span whole) {
  constexpr std::size_t strata = 32;
  const double close = whole.width() / 1024;
  if (values.size() <= quantiles) return {};
  std::vector<double> near;
  const std::vector<double> all = quantiles_of(values);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!(all[i] > whole.low && all[i] < whole.high)) continue;
    const bool below = i > 0 && all[i] - all[i - 1] < close;
    const bool above = i + 1 < all.size() && all[i + 1] - all[i] < close;
    if (below || above) near.push_back(all[i]);
  }
  // A peak of few values stands out among those of its own density.
  for (std::size_t k = 0; k < strata; ++k) {
    const std::size_t first = k * values.size() / strata;
    const auto stratum = values.subspan(first, (k + 1) * values.size() / strata - first);
    if (stratum.size() <= quantiles) continue;
    const std::vector<double> some = quantiles_of(stratum);
    for (std::size_t i = 1; i + 1 < some.size(); ++i) {
      const double gap = std::max(some[i] - some[i - 1], some[i + 1] - some[i]);
      const auto after = std::ranges::lower_bound(near, some[i]);
      const bool is_near = (after != near.end() && *after - some[i] < 16 * gap) ||
                           (after != near.begin() && some[i] - after[-1] < 16 * gap);
      if (gap < close / 2 && !is_near) near.insert(after, some[i]);
    }
  }
  std::vector<double> borders = near;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double before = i > 0 ? near[i - 1] : whole.low;
    const double after = i + 1 < near.size() ? near[i + 1] : whole.high;
    grade(near[i], after, near[i] - before, borders);
    grade(near[i], before, after - near[i], borders);
  }
  std::ranges::sort(borders);
  return borders;
}

namespace {

using Slopes = TabulatedLaw::Slopes;

constexpr int places_compared = 7;
constexpr double largest_departure = 1e-6;

// P_0 to P_nodes at t, by Bonnet's recursion.
std::array<double, nodes + 1> legendre(double t) {
  std::array<double, nodes + 1> p{1, t};
  for (std::size_t k = 1; k < nodes; ++k) {
    const double degree = static_cast<double>(k);
    p[k + 1] = ((2 * degree + 1) * t * p[k] - degree * p[k - 1]) / (degree + 1);
  }
  return p;
}

// P_1 to P_(nodes - 1) at every node.
const std::array<Slopes, nodes>& legendre_at_nodes() {
  static const std::array<Slopes, nodes> table = [] {
    std::array<Slopes, nodes> all{};
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto p = legendre(node_places()[i]);
      std::copy(p.begin() + 1, p.end() - 1, all[i].begin());
    }
    return all;
  }();
  return table;
}

// A part's mass and how it is spread. int_-1^t P_k = (P_k+1 - P_k-1) / (2 k + 1). The k-th
// coefficient of the interpolant is (2 k + 1) / 2 sum w_i f_i P_k(t_i), exact for degree 6.
struct Spread {
  Integral mass;
  Slopes slopes = {};
  double unseen = 0;  // Mass that a jump beyond the outermost nodes may add or take.

  Spread(const AdaptiveQuadrature::Sampled& sampled, double width)
      : mass(sampled.integral), unseen(blind_share * width * sampled.departure_at_ends) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const Slopes& p = legendre_at_nodes()[i];
      for (std::size_t k = 0; k < slopes.size(); ++k) slopes[k] += sampled.parts[i] * p[k] / 2;
    }
  }
};

// The mass below t in [-1, 1].
double mass_below(double t, double mass, const Slopes& slopes) {
  const auto p = legendre(t);
  double sum = mass / 2 * (t + 1);
  for (std::size_t k = 0; k < slopes.size(); ++k) sum += slopes[k] * (p[k + 2] - p[k]);
  return sum;
}

// The distance between a part's law inside it and that of its halves.
double largest_distance(const Spread& whole, const Spread& first, const Spread& second) {
  const auto below = [](double t, const Spread& of) {
    return mass_below(t, of.mass.value, of.slopes);
  };
  double largest = 0;
  for (int k = 1; k <= places_compared; ++k) {
    const double t = 2.0 * k / (places_compared + 1) - 1;
    const double by_halves =
        t <= 0 ? below(2 * t + 1, first) : first.mass.value + below(2 * t - 1, second);
    largest = std::max(largest, std::abs(by_halves - below(t, whole)));
  }
  return largest;
}

struct Part {
  Span span;
  Spread first;   // Lower half.
  Spread second;  // Upper half.
  double error = 0;
  double departure = 0;

  double badness(double tolerance) const {
    return std::max(departure / largest_departure, error / tolerance);
  }
};

// Contiguous parts, halved level by level. So the evaluations help everywhere if they run out.
class Table {
 public:
  Table(const AdaptiveQuadrature::Function& density, AdaptiveQuadrature& rule)
      : density_(density), rule_(rule) {}

  void add(Span span) { add(span, spread(span), 0); }

  void refine() {
    std::size_t before = 0;
    for (int depth = 0; depth < deepest_bisection && parts_.size() > before; ++depth) {
      before = parts_.size();
      for (const Part& part : std::exchange(parts_, {})) {
        if (rule_.exhausted() || part.badness(rule_.limits().tolerance) <= 1) {
          parts_.push_back(part);
          continue;
        }
        const auto [low, high] = part.span.halves();
        add(low, part.first, part.departure / 4);
        add(high, part.second, part.departure / 4);
      }
    }
  }

  TabulatedLaw result() const {
    TabulatedLaw law{.place = {parts_.front().span.low}, .cumulated = {0}};
    double departure = 0;
    for (const Part& part : parts_) {
      append(law, part.span.middle(), part.first);
      append(law, part.span.high, part.second);
      law.total_error += part.error;
      departure = std::max(departure, part.departure);
    }
    check::positive({"tabulate", "mass"}, law.total());
    law.error = (departure + law.total_error) / law.total();
    return law;
  }

 private:
  Spread spread(Span span) { return {rule_.sampled(density_, span), span.width()}; }

  // Part of the departure is inherited from the part that this is a half of. Two halves that agree
  // by luck do so once.
  void add(Span span, const Spread& whole, double inherited) {
    const auto [low, high] = span.halves();
    Part part{.span = span, .first = spread(low), .second = spread(high)};
    const Integral sum = part.first.mass + part.second.mass;
    part.error = std::max(std::abs(sum.value - whole.mass.value), sum.error);
    const double seen = largest_distance(whole, part.first, part.second);
    part.departure = std::max(seen + part.first.unseen + part.second.unseen, inherited);
    parts_.push_back(part);
  }

  static void append(TabulatedLaw& law, double place, const Spread& part) {
    law.place.push_back(place);
    law.cumulated.push_back(law.cumulated.back() + part.mass.value);
    law.slopes.push_back(part.slopes);
  }

  const AdaptiveQuadrature::Function& density_;
  AdaptiveQuadrature& rule_;
  std::vector<Part> parts_;
};

}  // namespace

double TabulatedLaw::operator()(double x) const {
  if (x <= place.front()) return 0;
  if (x >= place.back()) return 1;
  const std::size_t above = count_up_to(place, x);
  const std::size_t part = above - 1;
  const double share = (x - place[part]) / (place[above] - place[part]);
  const double mass = cumulated[above] - cumulated[part];
  // The polynomial may leave its part's range next to a jump.
  const double within = std::clamp(mass_below(2 * share - 1, mass, slopes[part]), 0.0, mass);
  return std::min(1.0, (cumulated[part] + within) / total());
}

TabulatedLaw tabulate(const AdaptiveQuadrature::Function& density, const std::vector<Span>& parts,
                      AdaptiveQuadrature& rule) {
  check::at_least({"tabulate", "number of parts"}, parts.size(), 1);
  Table table(density, rule);
  for (const Span& part : parts) table.add(part);
  table.refine();
  return table.result();
}

}  // namespace assay::stats
