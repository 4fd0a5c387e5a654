// A constant with a rare spike and a little noise: X = 1/2 + h [u < p] + w V, V uniform on (-1, 1).
// E[X] = 1/2 + p h, Var X = p (1 - p) h^2 + w^2 / 3. In N primaries the spike stays unseen with
// probability (1 - p)^N, and nothing in the sample then tells of it.

#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
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

std::vector<Entry> analytic_rare_spike() {
  return {{{.name = "analytic/rare_spike",
            .summary = "The constant 1/2 with a rare spike.",
            .description = "Estimates 1/2 + p h by 1/2, and with probability p by 1/2 + h, plus "
                           "noise uniform on (-w, w). Variance p (1 - p) h^2 + w^2 / 3.",
            .parameters = {{.name = "probability",
                            .summary = "p, of a spike",
                            .fallback = "1e-5",
                            .low = 0,
                            .high = 1},
                           {.name = "height",
                            .summary = "h, what a spike adds",
                            .fallback = "1000",
                            .low = 0,
                            .high = 1e12},
                           {.name = "noise",
                            .summary = "w, half the width of the noise",
                            .fallback = "0",
                            .low = 0,
                            .high = 1e12},
                           {.name = "declared",
                            .type = ParameterType::boolean,
                            .summary = "whether the range of the values is declared",
                            .fallback = "true"}}},
           prepare}};
}

}  // namespace assay::plugins
