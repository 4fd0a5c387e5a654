#include "harness/families/evidence_quantile.h"

#include <cmath>
#include <utility>

#include "harness/theta/theta.h"
#include "stats/basics/sorted.h"
#include "stats/laws/quantile_test.h"

namespace assay::harness {
namespace {

std::vector<double> sorted(std::span<const double> values, double factor) {
  std::vector<double> copy(values.begin(), values.end());
  for (double& value : copy) value *= factor;
  return stats::sorted(std::move(copy));
}

/// The sample quantile.
double middle(const std::vector<double>& sorted, double probability) {
  return sorted[stats::sample_quantile_rank(sorted.size(), probability)];
}

Evidence against_number(const Question& question, std::size_t channel, std::vector<double> values) {
  const double probability = question.test->claim.left.arguments[0];
  const double null = question.references[channel].value;
  const bool relative = question.theta->is_relative(question, channel);
  const double unit = relative ? std::abs(null) : 1;
  const double estimate = middle(values, probability);
  const auto at = [values, probability, null, unit](double theta) {
    return stats::quantile_test(stats::count_around(values, null + theta * unit), probability);
  };
  const auto interval = [values, probability, null, unit](double confidence) {
    stats::Interval found = stats::quantile_interval(values, probability, confidence);
    found.low = (found.low - null) / unit;
    found.high = (found.high - null) / unit;
    return found;
  };
  return {.estimate = (estimate - null) / unit,
          .at = at,
          .interval = interval,
          .quantity = relative ? "relative difference of the quantile from the reference"
                               : "difference of the quantile from the reference",
          .relative = relative};
}

}  // namespace

Evidence evidence_of_quantile(const Question& question, std::size_t channel,
                              std::span<const ChannelData> data) {
  std::vector<double> x = sorted(data[0].values, 1);
  if (!question.of_two()) return against_number(question, channel, std::move(x));
  // The quantile of c y is c times that of y, c > 0.
  const std::vector<double> y = sorted(data[1].values, question.factor);
  const double probability = question.test->claim.left.arguments[0];
  const double estimate = middle(x, probability) - middle(y, probability);
  const auto at = [x, y, probability](double theta) {
    return stats::quantile_compare(x, y, {.probability = probability, .offset = theta});
  };
  const auto interval = [x, y, probability](double confidence) {
    return stats::quantile_difference_interval(x, y, probability, confidence);
  };
  return {
      .estimate = estimate, .at = at, .interval = interval, .quantity = "difference of quantiles"};
}

}  // namespace assay::harness
