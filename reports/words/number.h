#pragma once

// Numbers as a reader wants them, in any locale. Effects are in per cent or the output's unit;
// logarithms of ratios become factors.

#include <cstdint>
#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The text for a number that does not exist.
inline constexpr const char* no_number = "n/a";

bool is_finite(const Number&);

/// The shortest decimal form that reads back as the same double; NaN, Infinity, -Infinity.
std::string round_trip(double value);

/// Rounded to `digits` significant digits (default 4), without trailing zeros: 0.4811, 12350,
/// 1.235e+07, 3.2e-05.
std::string human(Number value, int digits = 4);

/// A fraction as per cent with three significant digits: 0.00312 gives "0.312 %".
std::string percent(double fraction);

/// A confidence as per cent with as many decimals as tell it from 100: 0.99 gives "99 %", 0.999825
/// gives "99.98 %".
std::string confidence_text(double confidence);

/// human() or percent(), with a sign always: +0.31 %.
std::string with_sign(double value, bool relative);

/// human() or percent(): a margin on an effect.
std::string magnitude(double value, bool relative);

/// 10 to this power with two significant digits, also far beyond a double's range: "2.3e-1205".
std::string scientific(double log10_value);

/// A p-value with two significant digits. Below 1e-4 it is made from log10_p when that is given,
/// since p itself may have underflowed: p = 0, log10_p = -1204.64 gives "2.3e-1205".
std::string p_text(Number p, Number log10_p);

/// A count: 1048576 gives "1.05 M", below 10 000 all digits.
std::string count_text(std::uint64_t count);

/// A count with its noun: "1 primary", "12.5 k primaries".
std::string counted(std::uint64_t count, const char* singular, const char* plural);

/// A whole number with all digits, in threes: 1048576 gives "1,048,576".
std::string in_commas(double whole);

/// A duration: "0 s", "4.1 ms", "12.3 s", "2 min 5 s", "3 h 20 min".
std::string duration(double seconds);

/// True where theta is the natural logarithm of a ratio ("ln(ratio of variances)").
bool is_ratio(const Effect&);

/// True where it is shown as a factor.
bool is_factor(const Effect&);

/// True of a size, which has no sign.
bool is_root_mean_square(const Effect&);

/// exp(theta), also far beyond a double's range: "0.0717".
std::string factor_text(double theta);

/// The name of the effect without the logarithm: "ratio of variances".
std::string effect_name(const Effect&);

/// One value of theta. A ratio is "+2.3 %" where the whole effect stays within a factor of 1.1 of
/// one, else "×0.7".
std::string theta_text(double theta, const Effect&);

/// True if the whole interval lies above this theta.
bool lies_above(const Effect&, double theta);
bool lies_below(const Effect&, double theta);

/// "-0.094 % to +0.156 %", "at least +0.12 %"; empty where there is none.
std::string range_text(const Effect&);

/// Estimate and interval: "+0.31 % (+0.12 % to +0.5 %)"; empty where there is no estimate.
std::string effect_text(const Effect&);

/// " (99 % interval: +0.12 % to +0.5 %)"; empty where there is no interval.
std::string named_range_text(const Effect&);

/// effect_text() with the confidence of its interval: "+0.31 % (99 % interval: +0.12 % to +0.5 %)".
std::string named_effect_text(const Effect&);

/// The distance of theta from no effect, as theta_text() without a sign: "0.31 %". A ratio gives
/// "10.9 %", or "a factor of 2.4" if the effect or theta is beyond a factor of two.
std::string size_text(double theta, const Effect&);

/// A margin on the effect, upwards: "0.5 %", "a factor of 2.4".
std::string margin_text(double margin, const Effect&);

}  // namespace assay::reports
