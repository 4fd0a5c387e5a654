#include "harness/theta/gate.h"

namespace assay::harness {

reports::Gate gate_of(const stats::Gate& gate, const std::string& where) {
  constexpr const char* states[] = {"green", "amber", "red"};
  return {.name = gate.name + where,
          .value = gate.value,
          .limit = gate.limit,
          .state = states[static_cast<int>(gate.state)]};
}

}  // namespace assay::harness
