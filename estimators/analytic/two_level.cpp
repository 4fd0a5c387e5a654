// X = D(u) + (W(u) / s) (Z_1 + ... + Z_N) with D = 1 + u, W = 4 u^2.
//
// E[X] = 3/2 + 4/3 = 17/6 for any s. Given u, E = 1 + u + 4 u^2 and Var = W^2 (E[N] + Var N) / s^2.
// With r the fraction of s,
//   Var X = 10.2 - (17/6)^2 + (16/5) (s + r (1 - r)) / s^2.

#include <cmath>

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters& given) {
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

}  // namespace

std::vector<Entry> analytic_two_level() {
  return {{{.name = "analytic/two_level",
            .summary = "One branching with roulette or splitting of a fractional number.",
            .description = "Estimates 17/6 by 1 + u + (4 u^2 / s) (sum of N exponentials), N = "
                           "floor(s + v). Unbiased for every s > 0; the diagnostic channel "
                           "`children` counts N, of mean s.",
            .parameters = {number_parameter("splitting", "s, the expected number of children", "1",
                                            {0, 1000, true})}},
           prepare}};
}

}  // namespace assay::plugins
