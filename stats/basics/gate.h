#pragma once

#include <string>

namespace assay::stats {

enum class GateState { green, amber, red };

// A diagnosis of one assumption. green: value within the planning bound. red: `low`, the lower
// confidence limit of the value, exceeds `limit`. amber: in between. On normal data red has
// probability below 1e-4 at every sample size; at a law whose value is the limit itself about 1e-3
// (README.md).
struct Gate {
  std::string name;
  double value = 0;
  double low = 0;
  double limit = 0;
  GateState state = GateState::green;
};

}  // namespace assay::stats
