#pragma once

// The order of drawn observations shows whether they are independent.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// True if a subject's observations are drawn one by one, and not as pictures. The order of rows is
/// judged in rows.h.
bool shows_order(const Subject& subject);

/// Why values with these gates on their order are not independent, or "". Adds red gates.
std::string why_dependent(const Subject& subject, std::span<const stats::Gate> order,
                          std::vector<Gate>& gates);

/// Judges what estimators drew in their pilots. Dependence makes every method invalid, a forced one
/// as well.
void judge_drawn_order(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
