#pragma once

// The order of drawn observations shows whether they are independent.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// Observations of a test that show their order. Offsets of a few per cent that hundreds of
/// neighbours share take thousands.
inline constexpr std::uint64_t ordered_values = 16384;

/// True if a subject's observations are drawn one by one, and not as pictures. The order of rows is
/// judged in rows.h.
bool shows_order(const Subject& subject);

/// Why values in this order are not independent (stats::drawn_order_gates), or "". Adds red gates.
/// Values that are not finite have no order.
std::string why_dependent(const Subject& subject, std::span<const double> values,
                          std::vector<Gate>& gates);

/// Judges what estimators drew in their pilots. Dependence makes every method invalid, a forced one
/// as well.
void judge_drawn_order(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
