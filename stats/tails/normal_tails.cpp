#include <algorithm>
#include <cmath>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/tails/special.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// ln P(X >= x) for x >= 30 from Laplace's continued fraction of Mills' ratio (DLMF 7.9.2). Forty
// terms reach full precision there.
double log_far_upper(double x) {
  constexpr double half_log_two_pi = 0.91893853320467274178;
  double fraction = x;
  for (int k = 40; k >= 1; --k) fraction = x + k / fraction;
  return -0.5 * x * x - half_log_two_pi - std::log(fraction);
}

double log_upper(double x) {
  return x < 30 ? std::log(0.5 * std::erfc(x / std::numbers::sqrt2)) : log_far_upper(x);
}

}  // namespace

double log_p_two_sided(LogTails tails) {
  return std::min(0.0, std::numbers::ln2 + std::min(tails.lower, tails.upper));
}

LogTails normal_tails(double x) {
  check::finite({"normal_tails", "x"}, x);
  return x >= 0 ? special::from_upper(log_upper(x)) : special::from_lower(log_upper(-x));
}

double normal_upper(double x) {
  check::finite({"normal_upper", "x"}, x);
  return x >= 0 ? special::clamp_log(log_upper(x)) : special::from_lower(log_upper(-x)).upper;
}

}  // namespace assay::stats
