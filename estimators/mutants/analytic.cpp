// The teaching estimators with one defect each.

#include <limits>

#include "analytic/exponential.h"
#include "analytic/normal.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> scaled(Parameters& parameters) {
  const double factor = parameters.number("factor");
  return averaging(Channel{.mean = analytic::integral()}, [factor](Stream& random) {
    return factor * analytic::integrand(random.uniform());
  });
}

// A substream decides if an observation is spoilt, so that all others are the original's.
std::shared_ptr<const Setup> rare_nan(Parameters& parameters) {
  const analytic::NormalLaw law = analytic::normal_law(parameters);
  const double probability = parameters.number("probability");
  return averaging(Channel{.mean = law.mean}, [law, probability](Stream& random) {
    const bool spoilt = random.substream(1).uniform() < probability;
    const double value = law(random);
    return spoilt ? std::numeric_limits<double>::quiet_NaN() : value;
  });
}

}  // namespace

std::vector<Entry> mutants_analytic() {
  return {{{.name = "mutants/scaled",
            .summary = "analytic/exponential_uniform times a factor.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by c e^(3u): biased by c - 1.",
            .parameters = {{.name = "factor",
                            .summary = "c, what every primary is multiplied by",
                            .fallback = "1.01",
                            .low = 0,
                            .high = 1000}},
            .original = "analytic/exponential_uniform",
            .defect = "every primary is multiplied by a factor."},
           scaled},
          {{.name = "mutants/rare_nan",
            .summary = "analytic/normal with an observation that is not a number, now and then.",
            .description =
                "A normal variable; with a given probability an observation is not a number.",
            .parameters = {{.name = "probability",
                            .summary = "of an observation that is not a number",
                            .fallback = "1e-3",
                            .low = 0,
                            .high = 1}},
            .original = "analytic/normal",
            .defect = "an observation is not a number now and then."},
           rare_nan}};
}

}  // namespace assay::plugins
