#include "stats/adaptive_quadrature.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>

#include "stats/check.h"

namespace assay::stats {
namespace {

using Rule = boost::math::quadrature::gauss<double, AdaptiveQuadrature::nodes>;

// So near to the end of a part that a border of panels lies outside, rounding included.
constexpr double nudge = 1e-9;
constexpr double blind_share = AdaptiveQuadrature::blind_share;
constexpr std::size_t low_end = AdaptiveQuadrature::nodes;
constexpr std::size_t high_end = low_end + 1;

AdaptiveQuadrature::Places places_in(Span span) {
  AdaptiveQuadrature::Places places;
  const double half = span.width() / 2;
  std::transform(AdaptiveQuadrature::node_places().begin(), AdaptiveQuadrature::node_places().end(),
                 places.begin(), [&](double node) { return span.middle() + half * node; });
  places[low_end] = span.low + nudge * span.width();
  places[high_end] = span.high - nudge * span.width();
  return places;
}

// Of the nodes, in the order of node_places().
const std::array<double, AdaptiveQuadrature::nodes>& node_weights() {
  static const std::array<double, AdaptiveQuadrature::nodes> weights = [] {
    std::array<double, AdaptiveQuadrature::nodes> all{Rule::weights()[0]};
    for (std::size_t i = 1; i < Rule::weights().size(); ++i) {
      all[2 * i - 1] = all[2 * i] = Rule::weights()[i];
    }
    return all;
  }();
  return weights;
}

// Mass that a border of the support may hide beyond the outermost nodes, from the densities at the
// part's ends.
double hidden(Span span, double sum, const AdaptiveQuadrature::Values& at) {
  const auto positive = std::count_if(at.begin(), at.begin() + AdaptiveQuadrature::nodes,
                                      [](const Integral& each) { return each.value > 0; });
  const double low = at[low_end].value;
  const double high = at[high_end].value;
  if (positive == 0) return blind_share * span.width() * (low + high);
  if (positive < static_cast<std::ptrdiff_t>(AdaptiveQuadrature::nodes))
    return 0;  // the border is seen
  return blind_share * sum * ((low > 0 ? 0 : 1) + (high > 0 ? 0 : 1));
}

}  // namespace

AdaptiveQuadrature::Values AdaptiveQuadrature::counted(const Places& densities) {
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
  const Values at = function(places_in(span));
  Sampled found{.ends = {at[low_end].value, at[high_end].value}};
  for (std::size_t i = 0; i < nodes; ++i) {
    const double weight = span.width() / 2 * node_weights()[i];
    found.parts[i] = weight * at[i].value;
    found.integral = found.integral + Integral{found.parts[i], weight * at[i].error};
  }
  found.integral.error += hidden(span, found.integral.value, at);
  return found;
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
