#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "stats/planning/power.h"

namespace assay::stats {

// A law says what is known of a method's p-values at the looks of one growing sample.
enum class LookLaw {
  unknown,                 // Each is valid at its own size.
  independent_increments,  // Their normal scores are those of boundary.h.
  anytime_valid,           // Each is valid whenever sampling stops.
};

// When a growing sample is looked at, and the levels at which each look rejects. The data are
// cumulative: look k sees the first sizes[k] observations. All is fixed before the first
// observation.
struct LookSchedule {
  std::vector<std::uint64_t> sizes;
  LookLaw law = LookLaw::unknown;
  // Nominal levels of each look: they keep the errors over all looks, each whether or not the other
  // stops sampling.
  std::vector<double> alpha;
  std::vector<double> beta;

  std::size_t count() const { return sizes.size(); }
};

// Errors over all looks. With two_sided, alpha is split over both sides. Beta has one side.
//  `unknown                 error / K
//   independent_increments  Wang & Tsiatis's boundary with delta 1/4; sizes are the times
//   anytime_valid           error`
// Throws std::domain_error: no size, sizes that do not ascend, errors outside (0, 1).
LookSchedule schedule_looks(std::vector<std::uint64_t> sizes, LookLaw law, ErrorRates errors);

struct LookRange {
  std::uint64_t first = 1;  // n_0
  std::uint64_t last = 1;
};

// n_k = n_0 r^k from range.first to range.last, rounded. Their number is the smallest whose ratio
// does not exceed `growth`. Then r is evened out so that the last size is range.last exactly. Sizes
// that round to the same are one. Throws std::domain_error: first < 1, last < first, growth not
// finite and above 1.
std::vector<std::uint64_t> geometric_sizes(LookRange range, double growth);

// One look at these errors.
LookSchedule one_look(std::uint64_t size, double alpha, double beta);

// Looks grow from `first` to the size that the last one's levels need. The factor is 2 without a
// law, else sqrt 2.
struct GrowingLooks {
  LookLaw law = LookLaw::unknown;
  ErrorRates errors = {};
  std::uint64_t first = 1;
  std::uint64_t least = 1;   // Size of the last look at least, above `first`.
  std::uint64_t needed = 1;  // Size that one look at these errors needs, or `least` if it is more.
  std::uint64_t most = 1;    // There are no more.
  std::size_t count = 1;     // Number of looks, at most; 10 without a law.
};

// The schedule with most looks whose last needs at most 4 times one look's size. An error that
// sampling does not reduce may put smaller levels beyond any number. `size` tells what a look at
// its levels needs. Nothing if one look alone is left.
std::optional<LookSchedule> growing_looks(
    const GrowingLooks& looks, const std::function<std::uint64_t(double alpha, double beta)>& size);

// Null hypothesis: that of every look. `log_p` holds ln p_k of the first looks, in order. A
// two-sided p_k is twice the smaller tail. The p-value is the least error over all looks at which
// one of those taken rejects (repeated p-value, Jennison & Turnbull 2000, ch. 9). It is at most an
// error exactly if a look rejects at that error's nominal level. It is valid wherever sampling
// stops. K looks are scheduled:
//  `unknown                 K min p_k (Bonferroni 1936)
//   independent_increments  P(some z_k t_k^(1/4) reaches the largest seen)
//   anytime_valid           min p_k`
// Throws std::domain_error: no look or more than scheduled, a log p above 0 or NaN.
double log_p_over_looks(const LookSchedule& schedule, std::span<const double> log_p,
                        bool two_sided);

}  // namespace assay::stats
