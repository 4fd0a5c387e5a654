// Variables whose means hang on values that are rarely drawn.

#include <cmath>

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

// u is the middle of one of 2^52 equal cells, never below 2^-53. The share of the k-th moment from
// below is 2^(-53 (1 - k/a)). It is less than 1e-4 for the mean if a >= 1.34, and for the variance
// if a >= 2.67. Nothing is declared below.

constexpr double least_index = 1.34;
constexpr double least_index_of_variance = 2.67;

std::shared_ptr<const Setup> heavy_tail(Parameters& parameters) {
  const double a = parameters.number("index");
  Channel channel{.mean = a / (a - 1), .low = 1};
  if (a >= least_index_of_variance) channel.variance = a / ((a - 1) * (a - 1) * (a - 2));
  return averaging(std::move(channel),
                   [a](Stream& random) { return std::pow(random.uniform_open(), -1 / a); });
}

std::shared_ptr<const Setup> rare_spike(Parameters& parameters) {
  const double p = parameters.number("probability");
  const double height = parameters.number("height");
  const double noise = parameters.number("noise");
  Channel channel{.mean = 0.5 + p * height,
                  .variance = p * (1 - p) * height * height + noise * noise / 3};
  if (parameters.boolean("declared")) {
    channel.low = 0.5 - noise;
    channel.high = 0.5 + height + noise;
  }
  return averaging(channel, [=](Stream& random) {
    const double base = random.uniform() < p ? 0.5 + height : 0.5;
    return noise > 0 ? base + noise * (2 * random.uniform() - 1) : base;
  });
}

}  // namespace

std::vector<Entry> analytic_tails() {
  return {
      {{.name = "analytic/heavy_tail",
        .summary = "A Pareto variable: heavy tails, infinite variance up to index 2.",
        .description =
            "Estimates a / (a - 1) by u^(-1/a). Variance a / ((a - 1)^2 (a - 2)) for a tail index "
            "a > 2 and infinite below; the kurtosis exists for a > 4 only. u has 52 bits. At the "
            "allowed indices less than 1e-4 of the mean lies beyond its smallest value. The "
            "variance is declared from 2.67 on, where it loses as little.",
        .parameters = {number_parameter("index", "a, the tail index", "3", {least_index, 1000})}},
       heavy_tail},
      {{.name = "analytic/rare_spike",
        .summary = "The constant 1/2 with a rare spike.",
        .description = "Estimates 1/2 + p h by 1/2, and with probability p by 1/2 + h, plus "
                       "noise uniform on (-w, w). Variance p (1 - p) h^2 + w^2 / 3.",
        .parameters = {number_parameter("probability", "p, of a spike", "1e-5", {0, 1}),
                       number_parameter("height", "h, what a spike adds", "1000", {0, 1e12}),
                       number_parameter("noise", "w, half the width of the noise", "0", {0, 1e12}),
                       boolean_parameter("declared", "whether the range of the values is declared",
                                         true)}},
       rare_spike}};
}

}  // namespace assay::plugins
