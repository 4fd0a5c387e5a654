#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/language/claim.h"

namespace assay::harness {

/// A parameter of a law: its name, and whether it must be positive.
struct LawParameter {
  std::string name;
  bool positive = false;
};

/// A continuous law, with Boost.Math's parameters in Boost.Math's order.
struct LawInformation {
  std::string name;
  std::vector<LawParameter> parameters;
  /// Gives the distribution function P(X <= x), by Boost.Math.
  std::function<double(double)> (*cdf)(const std::vector<double>& arguments);
};

/// All laws that a claim can name except `density`, the sampler's own.
const std::vector<LawInformation>& laws();

/// Null if there is none.
const LawInformation* find_law(std::string_view name);

/// InputError at the law's place for a wrong number of arguments or an argument out of range.
void check_law(const Law&);

/// "normal(mean, sd)".
std::string signature(const LawInformation&);

}  // namespace assay::harness
