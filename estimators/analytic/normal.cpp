// A normal variable, X = mu + sigma Z: E[X] = mu, Var X = sigma^2, the law that every test is exact
// for.

#include "analytic/normal.h"

namespace assay::analytic {

std::vector<ParameterInformation> normal_parameters() {
  return {{.name = "mean", .summary = "mu", .fallback = "0", .low = -1e300, .high = 1e300},
          {.name = "deviation", .summary = "sigma", .fallback = "1", .low = 0, .high = 1e150}};
}

NormalLaw normal_law(Parameters& parameters) {
  const double mean = parameters.number("mean");
  return {.mean = mean, .deviation = parameters.number("deviation")};
}

}  // namespace assay::analytic

namespace assay::plugins {

std::vector<Entry> analytic_normal() {
  return {{{.name = "analytic/normal",
            .summary = "A normal variable.",
            .description = "Estimates mu by mu + sigma Z, Z standard normal (Box and Muller).",
            .parameters = analytic::normal_parameters()},
           [](Parameters& given) {
             const analytic::NormalLaw law = analytic::normal_law(given);
             return averaging(Channel{.mean = law.mean, .variance = law.deviation * law.deviation},
                              law);
           }}};
}

}  // namespace assay::plugins
