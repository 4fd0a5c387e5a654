#pragma once

#include <string>
#include <vector>

#include "harness/language/claim.h"

namespace assay::harness {

/// A parameter of a law: its name in messages, and whether it must be above 0.
struct LawParameter {
  std::string name;
  bool positive = false;
};

/// A continuous law that a claim can name, with Boost.Math's parameters in Boost.Math's order.
struct LawInformation {
  std::string name;
  std::vector<LawParameter> parameters;
};

/// All laws a claim can name, but `density`, which is the sampler's own.
const std::vector<LawInformation>& laws();

/// The law of that name, or nullptr.
const LawInformation* find_law(std::string_view name);

/// InputError at the law's place for a wrong number of arguments or one out of range.
void check_law(const Law&);

/// "normal(mean, sd)".
std::string signature(const LawInformation&);

}  // namespace assay::harness
