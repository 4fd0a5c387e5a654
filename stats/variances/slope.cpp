#include "stats/variances/slope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/basics/moments.h"
#include "stats/basics/search.h"
#include "stats/planning/planning.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double exact_tolerance = 1e-12;

void check_points(const char* function, const SlopeData& data) {
  check::at_least({function, "points"}, data.points.size(), 2);
  check::non_negative({function, "reference_error"}, data.reference_error);
  for (const SlopePoint& point : data.points) {
    check::positive({function, "size"}, point.size);
    check::finite({function, "estimate"}, point.estimate);
    check::non_negative({function, "standard_error"}, point.standard_error);
    if (point.standard_error == 0)
      throw ZeroVariance(std::string(function) + ": a standard error is zero");
  }
  for (std::size_t i = 1; i < data.points.size(); ++i) {
    if (data.points[i].size == data.points[i - 1].size) {
      check::fail({function, "size"}, data.points[i].size, "different from every other size");
    }
  }
}

SlopeData ordered(const char* function, SlopeData data) {
  std::ranges::sort(data.points, {}, &SlopePoint::size);
  check_points(function, data);
  return data;
}

// The quadratic form of V^-1, V = diag + u^2 1 1'. It is split into the part around the weighted
// mean and the mean's own part, so that a large u cancels nothing.
class Metric {
 public:
  explicit Metric(const SlopeData& data) {
    for (const SlopePoint& point : data.points) {
      weights_.push_back(1 / (point.standard_error * point.standard_error));
    }
    total_ = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    const double u = data.scale == SlopeScale::values ? data.reference_error : 0;
    mean_weight_ = total_ / (1 + u * u * total_);
  }

  double operator()(const std::vector<double>& a, const std::vector<double>& b) const {
    const double mean_a = mean(a);
    const double mean_b = mean(b);
    double sum = mean_weight_ * mean_a * mean_b;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += weights_[i] * (a[i] - mean_a) * (b[i] - mean_b);
    }
    return sum;
  }

 private:
  double mean(const std::vector<double>& a) const {
    return std::inner_product(a.begin(), a.end(), weights_.begin(), 0.0) / total_;
  }

  std::vector<double> weights_;
  double total_ = 0;
  double mean_weight_ = 0;
};

// Q(s), the squared length of the residual from the best multiple of the shape.
class Misfit {
 public:
  explicit Misfit(const SlopeData& data) : metric_(data), scale_(data.scale) {
    for (const SlopePoint& point : data.points) {
      log_size_.push_back(std::log(point.size));
      estimate_.push_back(point.estimate);
    }
  }

  double operator()(double slope) const {
    std::vector<double> rest = estimate_;
    std::vector<double> shape(estimate_.size(), 1.0);
    if (scale_ == SlopeScale::logarithms) {
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= slope * (log_size_[i] - middle());
    } else {
      // Scaled so that its largest entry is 1. Any slope up to the steepest is then representable.
      const double anchor = slope > 0 ? log_size_.back() : log_size_.front();
      for (std::size_t i = 0; i < rest.size(); ++i) {
        shape[i] = std::exp(slope * (log_size_[i] - anchor));
      }
    }
    const double multiple = metric_(shape, rest) / metric_(shape, shape);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= multiple * shape[i];
    return metric_(rest, rest);
  }

  double extent() const { return log_size_.back() - log_size_.front(); }

  // Beyond this slope M^s is one point only, to within e^-40 of it.
  double steepest() const {
    const std::size_t last = log_size_.size() - 1;
    const double gap = std::min(log_size_[1] - log_size_[0], log_size_[last] - log_size_[last - 1]);
    return 40 / gap;
  }

  double log_slope() const {
    std::vector<double> position = log_size_;
    for (double& x : position) x -= middle();
    const std::vector<double> one(position.size(), 1.0);
    const double lever = metric_(position, one) / metric_(one, one);
    for (double& x : position) x -= lever;
    return metric_(position, estimate_) / metric_(position, position);
  }

 private:
  double middle() const { return std::midpoint(log_size_.front(), log_size_.back()); }

  Metric metric_;
  SlopeScale scale_;
  std::vector<double> log_size_;
  std::vector<double> estimate_;
};

struct Node {
  double slope;
  double misfit;
};

// Slopes from the steepest fall to the steepest rise, with every local minimum of Q among them.
// Around zero the steps are a hundredth of the scale 1 / ln(largest / smallest size). Further out
// they are relative.
std::vector<Node> scan(const Misfit& misfit) {
  const double unit = 1 / misfit.extent();
  const double far = std::asinh(misfit.steepest() / unit);
  const int steps = static_cast<int>(std::ceil(far * 100));
  std::vector<double> slopes;
  for (int i = -steps; i <= steps; ++i) slopes.push_back(unit * std::sinh(far * i / steps));
  std::vector<Node> nodes;
  for (const double slope : slopes) nodes.push_back({slope, misfit(slope)});
  const std::size_t grid = nodes.size();
  for (std::size_t i = 1; i + 1 < grid; ++i) {
    if (nodes[i].misfit > nodes[i - 1].misfit || nodes[i].misfit > nodes[i + 1].misfit) continue;
    const Maximum least = maximum([&](double slope) { return -misfit(slope); }, nodes[i - 1].slope,
                                  nodes[i + 1].slope);
    nodes.push_back({least.place, -least.value});
  }
  std::ranges::sort(nodes, {}, &Node::slope);
  return nodes;
}

// On logarithms Q is a parabola, so three nodes suffice.
std::vector<Node> candidates(const SlopeData& data, const Misfit& misfit) {
  if (data.scale == SlopeScale::values) return scan(misfit);
  const double best = misfit.log_slope();
  const double least = misfit(best);
  const double curvature = misfit(best + 1) - least;
  // Here Q - least is 1e8, beyond any threshold of use.
  const double far = 1e4 / std::sqrt(curvature);
  return {{best - far, misfit(best - far)}, {best, least}, {best + far, misfit(best + far)}};
}

double degrees_of(const SlopeData& data) { return static_cast<double>(data.points.size()) - 1; }

double log_p(double misfit, double degrees) { return chi_square_tails(misfit, degrees).upper; }

/// The range of slopes between neighbours.
struct ExactSlopes {
  double low = infinity;
  double high = -infinity;

  double middle() const { return (low + high) / 2; }
};

bool is_exact(const SlopeData& data) {
  return std::ranges::all_of(data.points,
                             [](const SlopePoint& point) { return point.standard_error == 0; });
}

ExactSlopes exact_slopes(const SlopeData& data) {
  ExactSlopes slopes;
  for (std::size_t i = 1; i < data.points.size(); ++i) {
    const SlopePoint& a = data.points[i - 1];
    const SlopePoint& b = data.points[i];
    const double slope = (b.estimate - a.estimate) / std::log(b.size / a.size);
    slopes.low = std::min(slopes.low, slope);
    slopes.high = std::max(slopes.high, slope);
  }
  return slopes;
}

TestResult exact_test(const ExactSlopes& slopes, double null_slope) {
  constexpr double impossible = std::numeric_limits<double>::lowest();
  TestResult result{.statistic = slopes.middle() - null_slope, .distribution = {"bound", {}}};
  if (slopes.high > null_slope + exact_tolerance) result.log_p_upper = impossible;
  if (slopes.low < null_slope - exact_tolerance) result.log_p_lower = impossible;
  return result;
}

}  // namespace

TestResult slope_test(const SlopeData& unordered, double null_slope) {
  check::finite({"slope_test", "null_slope"}, null_slope);
  const SlopeData data = ordered("slope_test", unordered);
  const Misfit misfit(data);
  const double degrees = degrees_of(data);
  const double here = misfit(null_slope);
  double below = here;
  double above = here;
  for (const Node& node : candidates(data, misfit)) {
    double& least = node.slope <= null_slope ? below : above;
    least = std::min(least, node.misfit);
  }
  return {here, {"chi-square", {degrees}}, log_p(above, degrees), log_p(below, degrees)};
}

Interval slope_set(const SlopeData& unordered, double confidence) {
  check::inside_unit({"slope_set", "confidence"}, confidence);
  const SlopeData data = ordered("slope_set", unordered);
  const Misfit misfit(data);
  const double threshold =
      chi_square_quantile({Tail::upper, std::log1p(-confidence)}, degrees_of(data));
  const std::vector<Node> nodes = candidates(data, misfit);
  const auto inside = [&](const Node& node) { return node.misfit <= threshold; };
  const auto first = std::find_if(nodes.begin(), nodes.end(), inside);
  if (first == nodes.end()) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, confidence};
  }
  const auto last = std::find_if(nodes.rbegin(), nodes.rend(), inside).base() - 1;
  // Q crosses the threshold between a slope inside the set and one outside.
  const auto excess = [&](double slope) { return misfit(slope) - threshold; };
  return {first == nodes.begin() ? -infinity : root(excess, {(first - 1)->slope, first->slope}, 50),
          last + 1 == nodes.end() ? infinity : root(excess, {last->slope, (last + 1)->slope}, 50),
          confidence};
}

SlopeEstimate slope_estimate(const SlopeData& unordered) {
  const SlopeData data = ordered("slope_estimate", unordered);
  const Misfit misfit(data);
  const std::vector<Node> nodes = candidates(data, misfit);
  const auto best = std::ranges::min_element(nodes, {}, &Node::misfit);
  SlopeEstimate estimate{.slope = best->slope, .log_p_best = log_p(best->misfit, degrees_of(data))};
  if (best == nodes.begin()) estimate.slope = -infinity;
  if (best + 1 == nodes.end()) estimate.slope = infinity;
  return estimate;
}

double log_p_of_power_law(const SlopeData& data) {
  if (!is_exact(data)) return slope_estimate(data).log_p_best;
  const ExactSlopes slopes = exact_slopes(data);
  return slopes.high - slopes.low > 2 * exact_tolerance ? -infinity : 0;
}

Evidence slope_evidence(const SlopeData& data, double null_slope) {
  if (is_exact(data)) {
    const ExactSlopes slopes = exact_slopes(data);
    const auto less = [=](double slope) {
      const double difference = slope - null_slope;
      return std::abs(difference) <= exact_tolerance ? 0 : difference;
    };
    return {.estimate = less(slopes.middle()),
            .at = [=](double theta) { return exact_test(slopes, null_slope + theta); },
            .interval = [=](double confidence) -> Interval {
              return {less(slopes.low), less(slopes.high), confidence};
            }};
  }
  return {.estimate = slope_estimate(data).slope - null_slope,
          .at = [=](double theta) { return slope_test(data, null_slope + theta); },
          .interval = [=](double confidence) -> Interval {
            // The set takes each end at the whole level.
            const Interval hull = slope_set(data, (1 + confidence) / 2);
            return {hull.low - null_slope, hull.high - null_slope, confidence};
          }};
}

double slope_power(const SlopeData& expected, double null_slope, double alpha) {
  check::finite({"slope_power", "null_slope"}, null_slope);
  check::inside_unit({"slope_power", "alpha"}, alpha);
  const SlopeData data = ordered("slope_power", expected);
  const double degrees = degrees_of(data);
  const double threshold = chi_square_quantile({Tail::upper, std::log(alpha)}, degrees);
  const double noncentrality = Misfit(data)(null_slope);
  if (noncentrality == 0) return alpha;
  return std::exp(noncentral_chi_square_tails(threshold, {degrees, noncentrality}).upper);
}

std::optional<double> slope_sample_factor(const SlopeData& expected, double null_slope,
                                          ErrorRates rates) {
  check::inside_unit({"slope_sample_factor", "beta"}, rates.beta);
  const double alpha = rates.two_sided ? rates.alpha / 2 : rates.alpha;
  constexpr double most = 0x1p60;
  const auto power = [&](double factor) {
    if (factor >= most) return 1.0;
    SlopeData larger = expected;
    for (SlopePoint& point : larger.points) point.standard_error /= std::sqrt(factor);
    return slope_power(larger, null_slope, alpha);
  };
  const double found = planning::smallest_effect(power, 1 - rates.beta, 0, 0x1p-40);
  return found < most ? std::optional(found) : std::nullopt;
}

}  // namespace assay::stats
