// X of a named law costs 1 + floor(r |X|) shadow rays: large values are dear, as long paths are.
// E[X] is the law's.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "analytic/law.h"
#include "analytic/variable.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  const analytic::Variable variable{analytic::law_of(parameters), 0, 1};
  const double rays = parameters.number("rays");
  return averaging(analytic::channel_of(variable), [=](Stream& random, Cost& cost) {
    const double x = variable(random);
    // So many as fit a counter: of a law that reaches so far no claim on costs is answered.
    cost.shadow_rays += 1 + static_cast<std::uint64_t>(std::min(rays * std::abs(x), 0x1p40));
    return x;
  });
}

}  // namespace

std::vector<Entry> analytic_costly_law() {
  return {{{.name = "analytic/costly_law",
            .summary = "A variable of a named law that costs rays in proportion to its size.",
            .description =
                "Estimates the mean of X, one of the laws of `analytic/law`, by X, which costs 1 + "
                "floor(r |X|) shadow rays: a cost that is random and depends on the value. `assay "
                "calibrate` measures claims on costs and efficiencies on it.",
            .parameters = {analytic::law_parameter(),
                           {.name = "rays",
                            .summary = "r, rays a unit of |X|",
                            .fallback = "100",
                            .low = 0,
                            .high = 1e6}}},
           prepare}};
}

}  // namespace assay::plugins
