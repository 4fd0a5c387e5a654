// Variables of known mean: branchings, heavy tails and rare spikes.

#include <cmath>

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

// X = D(u) + (W(u) / s) (Z_1 + ... + Z_N) with D = 1 + u, W = 4 u^2.
//
// E[X] = 3/2 + 4/3 = 17/6 for any s. Given u, E = 1 + u + 4 u^2 and Var = W^2 (E[N] + Var N) / s^2.
// With r the fraction of s,
//   Var X = 10.2 - (17/6)^2 + (16/5) (s + r (1 - r)) / s^2.

std::shared_ptr<const Setup> two_level(Parameters& given) {
  const double s = given.number("splitting");
  const double whole = std::floor(s);
  const double of_count = (s - whole) * (1 - (s - whole));
  const double mean = 17.0 / 6;
  return setup_of({.channels = {{.mean = mean,
                                 .variance = 10.2 - mean * mean + 3.2 * (s + of_count) / (s * s),
                                 .low = 1},
                                {.name = "children",
                                 .mean = s,
                                 .variance = of_count,
                                 .low = whole,
                                 .high = std::ceil(s),
                                 .diagnostic = true}},
                   .make = estimating([s](Stream& random, std::uint64_t primaries,
                                          std::span<double> out, Cost& cost) {
                     double value = 0;
                     double children = 0;
                     for (std::uint64_t i = 0; i < primaries; ++i) {
                       const double u = random.uniform();
                       const double count = std::floor(s + random.uniform());
                       double sum = 0;
                       for (double k = 0; k < count; ++k) sum -= std::log(random.uniform_open());
                       children += count;
                       value += 1 + u + 4 * u * u / s * sum;
                     }
                     out[0] = value / static_cast<double>(primaries);
                     out[1] = children / static_cast<double>(primaries);
                     cost.samples += primaries;
                   })});
}

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

std::vector<Entry> analytic_variables() {
  return {
      {{.name = "analytic/two_level",
        .summary = "One branching with roulette or splitting of a fractional number.",
        .description = "Estimates 17/6 by 1 + u + (4 u^2 / s) (sum of N exponentials), N = "
                       "floor(s + v). Unbiased for every s > 0; the diagnostic channel "
                       "`children` counts N, of mean s.",
        .parameters = {number_parameter("splitting", "s, the expected number of children", "1",
                                        {0, 1000, true})}},
       two_level},
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
