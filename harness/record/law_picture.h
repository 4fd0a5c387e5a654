#pragma once

// Empirical laws for the record, with their simultaneous bands.

#include <cstddef>
#include <vector>

#include "harness/run/evaluate.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Of a claim about laws of one coordinate that is tested on values: each side's empirical
/// distribution function at 63 places at most, equally spaced in rank, with the claimed law there.
/// The band's error is the channel's share of alpha at the look. Draws without a point are left
/// out. Empty for all other claims.
std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel);

}  // namespace assay::harness
