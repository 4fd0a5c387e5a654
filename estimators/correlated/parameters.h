#pragma once

// The parameters that the estimators of the family share, and their static information.

#include <functional>
#include <string>
#include <vector>

#include "correlated/estimators.h"

namespace assay::correlated {

/// `lambda`, of the estimator that is given it.
ParameterInformation lambda_parameter();
/// `centre` and `clamped`, of those that estimate it.
std::vector<ParameterInformation> rule_parameters();
LambdaRule read_rule(Parameters&);

/// A source of pairs from a plugin's parameters.
using ReadPairs = std::function<SharedPairs(Parameters&)>;

/// The names of one kind of source, and how it is made.
struct Family {
  std::string name;         ///< "correlated/area"
  std::string integral;     ///< "the irradiance from ..."
  std::string description;  ///< of f, g, p and J
  std::vector<ParameterInformation> parameters;
  ReadPairs read;
};

/// The four estimators of a source: NAME, NAME_same_samples, NAME_cross_fitted, NAME_ratio.
std::vector<Entry> entries(const Family&);

}  // namespace assay::correlated
