#pragma once

#include <string>

#include "reports/record/record.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// A gate as a record has it. `where` follows its name.
reports::Gate gate_of(const stats::Gate& gate, const std::string& where);

}  // namespace assay::harness
