#pragma once

// The parameters that chains share.

#include <vector>

#include "metropolis/chain.h"
#include "metropolis/target_description.h"

namespace assay::metropolis {

/// target, pixels, p_large, bootstrap and boundary.
std::vector<ParameterInformation> chain_parameters();
/// `weights`, of chains that may have either.
ParameterInformation weights_parameter();

/// Parameters that a plugin reads before it knows its rules and its start.
struct Ingredients {
  SharedTarget target;
  double p_large;
  std::uint64_t bootstrap;
  Boundary boundary;
};
Ingredients read_ingredients(Parameters& given);
std::shared_ptr<const Rules> read_rules(Parameters& given, double p_large);

/// A sound chain with these rules, started from the bootstrap.
Recipe recipe(const Ingredients& ingredients, std::shared_ptr<const Rules> rules);

}  // namespace assay::metropolis
