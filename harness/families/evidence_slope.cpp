#include "harness/families/evidence_slope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/families/costs.h"
#include "harness/theta/constant.h"
#include "stats/gates/assumption_gates.h"
#include "stats/variances/influence.h"
#include "stats/variances/slope.h"

namespace assay::harness {
namespace {

using stats::Moments;
using stats::SlopeData;
using stats::SlopePoint;

// The gate is red below this p, however small the test's level.
constexpr double least_p_of_fit = 1e-5;

/// Each point of a bias has a truth.
bool of_biases(const Question& question) { return !question.truths.empty(); }

bool of_logarithms(const Question& question) {
  return question.is().of_spread || of_costs(question);
}

/// The cost or the variance of a primary at point i.
stats::Influence influence_of(const Question& question, std::size_t i, const ChannelData& data) {
  const double averaged = std::log(question.subjects[i].averaged(data.primaries));
  stats::Influence influence = of_costs(question)
                                   ? stats::influence_of_mean(counted_cost(question, data).cost())
                                   : stats::influence_of_variance(powers_of_values(data));
  influence.log_value += of_costs(question) ? -averaged : averaged;
  return influence;
}

/// True if one reference serves all points: its error shifts them together.
bool reference_is_shared(const Question& question) {
  return question.has_reference_subject || question.test->reference_number ||
         question.test->over->parameter == "primaries";
}

SlopeData biases(const Question& question, std::size_t channel, std::span<const ChannelData> data) {
  SlopeData slope;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const Moments& x = data[i].moments;
    SlopePoint point{
        .size = question.sizes[i], .estimate = x.mean, .standard_error = x.standard_error()};
    if (of_biases(question)) {
      const Constant truth = truth_of(question, i, channel, data);
      point.estimate -= truth.value;
      if (reference_is_shared(question)) {
        slope.reference_error = truth.standard_error;
      } else {
        point.standard_error = std::hypot(point.standard_error, truth.standard_error);
      }
    }
    slope.points.push_back(point);
  }
  return slope;
}

SlopeData points_of(const Question& question, std::size_t channel,
                    std::span<const ChannelData> data) {
  if (!of_logarithms(question)) return biases(question, channel, data);
  SlopeData slope{.scale = stats::SlopeScale::logarithms};
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const stats::Influence influence = influence_of(question, i, data[i]);
    slope.points.push_back({.size = question.sizes[i],
                            .estimate = influence.log_value,
                            .standard_error = influence.relative.standard_error()});
  }
  return slope;
}

bool is_exact(const SlopeData& data) {
  return std::all_of(data.points.begin(), data.points.end(),
                     [](const SlopePoint& point) { return point.standard_error == 0; });
}

/// Least and largest slope between neighbours, without error.
struct Slopes {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

Slopes exact_slopes(const SlopeData& data) {
  Slopes slopes;
  for (std::size_t i = 1; i < data.points.size(); ++i) {
    const SlopePoint& a = data.points[i - 1];
    const SlopePoint& b = data.points[i];
    const double slope = (b.estimate - a.estimate) / std::log(b.size / a.size);
    slopes.least = std::min(slopes.least, slope);
    slopes.most = std::max(slopes.most, slope);
  }
  return slopes;
}

// Bound on the rounding of quotients of logarithms of whole numbers.
constexpr double exact_tolerance = 1e-12;

/// Distance of a slope from the claimed one; 0 within rounding.
double beyond(double slope, double null) {
  const double difference = slope - null;
  return std::abs(difference) <= exact_tolerance ? 0 : difference;
}

/// Costs that never vary have exact slopes.
Evidence exact_evidence(const SlopeData& data, double null) {
  const Slopes slopes = exact_slopes(data);
  constexpr double impossible = std::numeric_limits<double>::lowest();
  const auto at = [=](double theta) {
    const double slope = null + theta;
    stats::TestResult result{.statistic = (slopes.least + slopes.most) / 2 - slope,
                             .distribution = {"bound", {}}};
    if (slopes.most > slope + exact_tolerance) result.log_p_upper = impossible;
    if (slopes.least < slope - exact_tolerance) result.log_p_lower = impossible;
    return result;
  };
  const auto interval = [=](double confidence) {
    return stats::Interval{beyond(slopes.least, null), beyond(slopes.most, null), confidence};
  };
  return {.estimate = beyond((slopes.least + slopes.most) / 2, null),
          .at = at,
          .interval = interval,
          .quantity = "difference from the claimed slope"};
}

}  // namespace

Evidence evidence_of_slope(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data) {
  const SlopeData points = points_of(question, channel, data);
  const double null = question.references[channel].value;
  if (is_exact(points)) return exact_evidence(points, null);
  const auto at = [=](double theta) { return stats::slope_test(points, null + theta).test; };
  const auto interval = [=](double confidence) {
    // The set takes each end at the whole level (stats/variances/slope.h).
    stats::Interval hull = stats::slope_set(points, (1 + confidence) / 2).hull;
    return stats::Interval{hull.low - null, hull.high - null, confidence};
  };
  return {.estimate = stats::slope_estimate(points).slope - null,
          .at = at,
          .interval = interval,
          .quantity = "difference from the claimed slope"};
}

std::vector<Gate> skewness_gates(const Question& question, std::size_t channel,
                                 std::span<const ChannelData> data, double critical) {
  std::vector<Gate> gates;
  // Channels share their costs: the first has the gates.
  if (!of_logarithms(question) || (of_costs(question) && channel != 0)) return gates;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    Moments relative = influence_of(question, i, data[i]).relative;
    if (!(relative.m2 > 0)) continue;
    // The bend of the logarithm takes 3/2 of their standard deviation off the skewness g1.
    relative.m3 -= 1.5 * relative.m2 * relative.m2 / static_cast<double>(relative.count);
    gates.push_back(gate_of(stats::skewness_gate(relative, critical),
                            " of " + question.subjects[i].estimator->name));
  }
  return gates;
}

Gate power_law_gate(const Question& question, std::size_t channel,
                    std::span<const ChannelData> data, double level) {
  const SlopeData points = points_of(question, channel, data);
  double log_p = 0;
  if (is_exact(points)) {
    const Slopes slopes = exact_slopes(points);
    if (slopes.most - slopes.least > 2 * exact_tolerance) log_p = std::log(0.0);
  } else {
    log_p = stats::slope_estimate(points).log_p_best;
  }
  const double limit = std::max(least_p_of_fit, level);
  return gate_of(reports::Gate{.name = "p of a power law",
                               .value = std::exp(log_p),
                               .limit = limit,
                               .state = log_p <= std::log(limit) ? "red" : "green"});
}

std::string point_without_spread(const Question& question, std::size_t channel,
                                 std::span<const ChannelData> data) {
  if (of_costs(question)) return "";
  for (std::size_t i = 0; i < question.compared(); ++i) {
    if (!is_constant(question, i, channel, data[i].moments)) continue;
    return fmt::format(
        "every observation of `{}` is {:.10g} but for rounding: of a point without spread no error "
        "is "
        "known, and a rare value may be unseen, so that no exponent is fitted",
        question.subjects[i].estimator->name, data[i].moments.mean);
  }
  return "";
}

}  // namespace assay::harness
