#pragma once

#include "estimators/core/value.h"
#include "tests/prelude.h"

namespace assay::harness {

/// "line:column: message" of the InputError that `act` throws ("message" without a line), or a text
/// that no message equals when it throws none.
template <class Act>
std::string refusal(Act act) {
  try {
    act();
  } catch (const InputError& e) {
    const Location& where = e.where();
    if (where.line == 0) return e.message();
    return std::to_string(where.line) + ":" + std::to_string(where.column) + ": " + e.message();
  }
  return "(nothing was refused)";
}

}  // namespace assay::harness
