#pragma once

// The effect of a claim in readable units. Differences are in per cent or the output's unit;
// logarithms of ratios become factors.

#include <string>

#include "reports/record/record_effect.h"

namespace assay::reports {

/// True where theta is the natural logarithm of a ratio ("ln(ratio of variances)").
bool is_ratio(const Effect&);

/// The name of the effect without the logarithm: "ratio of variances".
std::string effect_name(const Effect&);

/// One value of theta. A ratio is "+12.3 %" where the whole effect stays within a factor of two of
/// one, else "×0.0717".
std::string theta_text(double theta, const Effect&);

/// "[-0.094 %, +0.156 %]", "[from +0.12 %]" where one-sided, empty where there is none.
std::string interval_text(const Effect&);

/// "99.98 % interval"; empty where there is no interval.
std::string interval_name(const Effect&);

/// Estimate and interval: "+0.31 % [+0.12 %, +0.5 %]"; empty where there is no estimate.
std::string effect_text(const Effect&);

/// effect_text() with the confidence of its interval: "+0.31 % [+0.12 %, +0.5 %] (99 % interval)".
std::string named_effect_text(const Effect&);

/// The distance of theta from no effect, as theta_text() without a sign: "0.31 %". A ratio gives
/// "10.9 %", or "a factor of 2.4" if the effect is shown as a factor or theta is one.
std::string size_text(double theta, const Effect&);

/// A margin on the effect, upwards: "0.5 %", "a factor of 2.4".
std::string margin_text(double margin, const Effect&);

}  // namespace assay::reports
