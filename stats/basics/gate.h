#pragma once

#include <string>

namespace assay::stats {

enum class GateState { green, amber, red };

// A diagnosis of one assumption. Green: the value is within the planning bound. Red: `low`, the
// lower confidence limit of the value, exceeds `limit`. Amber: in between. On normal data red has
// probability below 1e-4 at every sample size. At a law whose value is the limit it has about 1e-3
// (measurements.md).
struct Gate {
  std::string name;
  double value = 0;
  double low = 0;
  double limit = 0;
  GateState state = GateState::green;
};

// The gate with its state.
inline Gate judged(Gate gate, double green_up_to) {
  gate.state = gate.value <= green_up_to ? GateState::green
               : gate.low > gate.limit   ? GateState::red
                                         : GateState::amber;
  return gate;
}

}  // namespace assay::stats
