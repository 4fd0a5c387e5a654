// The integral of f(x) = e^(3x) over [0, 1] by weighted importance sampling.
//
// I^ = sum f(x_i) / sum g(x_i), x uniform and g(x) = 5 (1 + x)^4 / 31, whose integral is 1. It is a
// ratio of means: biased and consistent. The reference is I = (e^3 - 1) / 3.
//   n (E[I^] - I) -> I Var g - Cov(f, g) = -0.50012,  n Var I^ -> Var(f - I g).
// Jackknifed, the bias falls like 1 / n^2.

#include "analytic/ratio.h"

namespace assay::plugins {

namespace {

using namespace analytic;

std::shared_ptr<const Setup> ratio(Parameters&) {
  // A ratio of sums lies between the extremes of f / g, at x = 1/3 and x = 1.
  return ratio_setup<SamePoint, RatioOfSums>(
      Channel{.mean = integral(),
              .low = integrand(1.0 / 3) / near_density(1.0 / 3),
              .high = integrand(1) / near_density(1)});
}

std::shared_ptr<const Setup> jackknifed(Parameters&) {
  return ratio_setup<SamePoint, Jackknife<BothLeftOut>>(Channel{.mean = integral()});
}

}  // namespace

std::vector<Entry> analytic_ratio() {
  return {{{.name = "analytic/ratio",
            .summary = "The integral of e^(3x) over [0, 1] by weighted importance sampling.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by sum e^(3x) / sum g(x), g(x) = 5 "
                           "(1 + x)^4 / 31 of integral 1, x uniform. The bias times the number of "
                           "primaries tends to -0.50012.",
            .bias = BiasClass::inverse_primaries,
            .averages = false},
           ratio},
          {{.name = "analytic/jackknifed_ratio",
            .summary = "The same, with the first term of the bias taken away.",
            .description =
                "analytic/ratio, R, jackknifed: M R - (M - 1) mean of the M ratios with one point "
                "left out (Quenouille 1956). The bias falls like 1 / M^2 where that of R falls "
                "like 1 / M; the variance is that of R but for terms 1 / M^2. From one point it "
                "is R.",
            .bias = BiasClass::inverse_primaries,
            .averages = false},
           jackknifed}};
}

}  // namespace assay::plugins
