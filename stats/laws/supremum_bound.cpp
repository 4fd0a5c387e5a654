#include "stats/laws/supremum_bound.h"

#include <algorithm>
#include <numbers>

#include "stats/tails/special.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

double log_massart(double a, std::uint64_t n) {
  if (a <= 0) return 0;
  return std::min(0.0, std::numbers::ln2 - 2 * static_cast<double>(n) * a * a);
}

}  // namespace

// With grid points b_0 = 0 < … < b_K = gap:
//   P(A + B >= gap) <= sum_k P(b_k <= B < b_{k+1}) P(A >= gap - b_{k+1}) + P(B >= gap).
double log_two_suprema_bound(double gap, TwoSizes sizes) {
  if (gap <= 0) return 0;
  constexpr int cells = 2000;
  double total = log_massart(gap, sizes.n);
  for (int k = 0; k < cells; ++k) {
    const double low = gap * k / cells;
    const double high = gap * (k + 1) / cells;
    const double tail_low = log_massart(low, sizes.n);
    const double tail_high = log_massart(high, sizes.n);
    if (tail_high >= tail_low) continue;
    const double mass = tail_low + log_complement(tail_high - tail_low);
    total = log_sum({total, mass + log_massart(gap - high, sizes.m)});
  }
  return special::clamp_log(total);
}

}  // namespace assay::stats
