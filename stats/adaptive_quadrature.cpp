#include "stats/adaptive_quadrature.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "stats/check.h"

namespace assay::stats {
namespace {

using Rule = boost::math::quadrature::gauss<double, AdaptiveQuadrature::nodes>;

// So near to the end of a part that a border of panels lies outside, rounding included.
constexpr double nudge = 1e-9;
constexpr double blind_share = AdaptiveQuadrature::blind_share;

struct Nodes {
  Integral sum;
  std::array<double, AdaptiveQuadrature::nodes> parts = {};
  std::size_t count = 0;
  bool some_zero = false;
  bool some_positive = false;

  void add(Integral value, double weight) {
    parts[count++] = weight * value.value;
    sum = sum + Integral{weight * value.value, weight * value.error};
    (value.value > 0 ? some_positive : some_zero) = true;
  }
};

Nodes at_nodes(const AdaptiveQuadrature::Function& function, Span span) {
  const double half = span.width() / 2;
  const auto& places = Rule::abscissa();  // of the upper half, 0 first
  const auto& weights = Rule::weights();
  Nodes nodes;
  nodes.add(function(span.middle()), half * weights[0]);
  for (std::size_t i = 1; i < places.size(); ++i) {
    nodes.add(function(span.middle() - half * places[i]), half * weights[i]);
    nodes.add(function(span.middle() + half * places[i]), half * weights[i]);
  }
  return nodes;
}

// Mass that a border of the support may hide beyond the outermost nodes, from the densities at the
// part's ends.
double hidden(Span span, const Nodes& nodes, double low, double high) {
  if (nodes.some_zero && nodes.some_positive) return 0;  // the border is seen
  if (nodes.some_zero) return blind_share * span.width() * (low + high);
  return blind_share * nodes.sum.value * ((low > 0 ? 0 : 1) + (high > 0 ? 0 : 1));
}

}  // namespace

Integral AdaptiveQuadrature::counted(double density) {
  check::non_negative({"AdaptiveQuadrature", "density"}, density);
  ++used_;
  largest_ = std::max(largest_, density);
  return {density, 0};
}

AdaptiveQuadrature::Sampled AdaptiveQuadrature::sampled(const Function& function, Span span) {
  const Nodes found = at_nodes(function, span);
  const double low = function(span.low + nudge * span.width()).value;
  const double high = function(span.high - nudge * span.width()).value;
  return {{found.sum.value, found.sum.error + hidden(span, found, low, high)},
          found.parts,
          {low, high}};
}

Integral AdaptiveQuadrature::once(const Function& function, Span span) {
  return sampled(function, span).integral;
}

const std::array<double, AdaptiveQuadrature::nodes>& AdaptiveQuadrature::node_places() {
  static const std::array<double, nodes> places = [] {
    std::array<double, nodes> all{};
    const auto& upper = Rule::abscissa();
    for (std::size_t i = 1; i < upper.size(); ++i) {
      all[2 * i - 1] = -upper[i];
      all[2 * i] = upper[i];
    }
    return all;
  }();
  return places;
}

Integral AdaptiveQuadrature::over(const Function& function, Span span) {
  return refined(function, span, once(function, span), limits_.deepest_bisection);
}

Integral AdaptiveQuadrature::refined(const Function& function, Span span, Integral whole,
                                     int depth) {
  const Span first{span.low, span.middle()};
  const Span second{span.middle(), span.high};
  const Integral one = once(function, first);
  const Integral two = once(function, second);
  const Integral sum = one + two;
  const double error = std::max(std::abs(sum.value - whole.value), sum.error);
  if (error <= limits_.tolerance || depth <= 0 || exhausted()) return {sum.value, error};
  return refined(function, first, one, depth - 1) + refined(function, second, two, depth - 1);
}

std::vector<Span> cut(Span span, Span whole, std::size_t panels) {
  std::vector<Span> parts;
  double low = span.low;
  const double width = whole.width() / static_cast<double>(panels);
  const double slack = 1e-12 * whole.width();
  for (std::size_t k = 1; k < panels; ++k) {
    const double border = whole.low + width * static_cast<double>(k);
    if (border <= span.low + slack || border >= span.high - slack) continue;
    parts.push_back({low, border});
    low = border;
  }
  parts.push_back({low, span.high});
  return parts;
}

}  // namespace assay::stats
