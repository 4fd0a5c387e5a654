#include "stats/tails/tabulated_law.h"

#include <algorithm>
#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"

namespace assay::stats {
namespace {

using Slopes = TabulatedLaw::Slopes;

constexpr std::size_t nodes = AdaptiveQuadrature::nodes;
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
      const auto p = legendre(AdaptiveQuadrature::node_places()[i]);
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
  // Mass that a jump beyond the outermost nodes may add or take. Neither the part nor its halves
  // see it. The density at the ends then departs from the interpolant.
  double unseen = 0;

  Spread(const AdaptiveQuadrature::Sampled& sampled, double width) : mass(sampled.integral) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const Slopes& p = legendre_at_nodes()[i];
      for (std::size_t k = 0; k < slopes.size(); ++k) slopes[k] += sampled.parts[i] * p[k] / 2;
    }
    for (const int end : {-1, 1}) {
      const double there = width * sampled.ends[end < 0 ? 0 : 1];
      unseen += AdaptiveQuadrature::blind_share * std::abs(there - 2 * density_at(end));
    }
  }

 private:
  // The interpolant at t = -1 or 1, from P_k(1) = 1 and P_k(-1) = (-1)^k. Its integral over t is
  // the mass.
  double density_at(int end) const {
    double sum = mass.value / 2;
    double sign = end;
    for (std::size_t k = 0; k < slopes.size(); ++k, sign *= end) {
      sum += slopes[k] * (2.0 * static_cast<double>(k) + 3) * sign;
    }
    return sum;
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
  double badness = 0;  // Above 1: to be halved.
  int depth = 0;

  bool operator<(const Part& other) const { return badness < other.badness; }
};

// Halves the worst part first, so that the evaluations go where they help most.
class Table {
 public:
  Table(const AdaptiveQuadrature::Function& density, AdaptiveQuadrature& rule)
      : density_(density), rule_(rule) {}

  void add(Span span) { add(span, spread(span), 0, 0); }

  void refine() {
    while (parts_.front().badness > 1 && !rule_.exhausted()) {
      std::pop_heap(parts_.begin(), parts_.end());
      const Part part = parts_.back();
      parts_.pop_back();
      const auto [low, high] = part.span.halves();
      add(low, part.first, part.departure / 4, part.depth + 1);
      add(high, part.second, part.departure / 4, part.depth + 1);
    }
  }

  TabulatedLaw result() {
    std::ranges::sort(parts_, {}, [](const Part& part) { return part.span.low; });
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
  void add(Span span, const Spread& whole, double inherited, int depth) {
    const auto [low, high] = span.halves();
    Part part{.span = span, .first = spread(low), .second = spread(high), .depth = depth};
    const Integral sum = part.first.mass + part.second.mass;
    part.error = std::max(std::abs(sum.value - whole.mass.value), sum.error);
    const double seen = largest_distance(whole, part.first, part.second);
    part.departure = std::max(seen + part.first.unseen + part.second.unseen, inherited);
    if (part.depth < deepest_bisection) {
      part.badness =
          std::max(part.departure / largest_departure, part.error / rule_.limits().tolerance);
    }
    parts_.push_back(part);
    std::push_heap(parts_.begin(), parts_.end());
  }

  static void append(TabulatedLaw& law, double place, const Spread& part) {
    law.place.push_back(place);
    law.cumulated.push_back(law.cumulated.back() + part.mass.value);
    law.slopes.push_back(part.slopes);
  }

  const AdaptiveQuadrature::Function& density_;
  AdaptiveQuadrature& rule_;
  std::vector<Part> parts_;  // A heap, the worst first.
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
