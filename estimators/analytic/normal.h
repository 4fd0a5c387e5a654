#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "estimators/estimator.h"

namespace assay::analytic {

/// Mean and standard deviation.
struct NormalLaw {
  double mean = 0;
  double deviation = 1;

  /// Box & Muller (1958), the cosine of the pair. `random` is a Stream or reads as one.
  double operator()(auto& random) const {
    const double radius = std::sqrt(-2 * std::log(random.uniform_open()));
    return mean + deviation * radius * std::cos(2 * std::numbers::pi * random.uniform());
  }
};

/// mean, deviation.
std::vector<ParameterInformation> normal_parameters();
NormalLaw normal_law(Parameters&);

}  // namespace assay::analytic
