#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>

#include "stats/check.h"
#include "stats/power.h"
#include "stats/tails.h"

namespace assay::stats::planning {

// Internal: what every method's planning shares.

inline void check_rates(const char* function, const ErrorRates& rates) {
  check::inside_unit({function, "alpha"}, rates.alpha);
  check::inside_unit({function, "beta"}, rates.beta);
}

// ln of the level of one tail.
inline double log_tail_level(const ErrorRates& rates) {
  return std::log(rates.two_sided ? rates.alpha / 2 : rates.alpha);
}

inline LogTail critical_tail(const ErrorRates& rates) {
  return {Tail::upper, log_tail_level(rates)};
}

inline double z_upper(double probability) {
  return normal_quantile({Tail::upper, std::log(probability)});
}

constexpr double most_samples = 0x1p53;

// The smallest whole n >= minimum at which `enough(n)`, which must be monotone; galloping from a
// guess, which is often exact: every step four times the last.
template <class Enough>
std::optional<std::uint64_t> smallest_sample(const Enough& enough, double guess, double minimum) {
  double n = std::max(minimum, std::floor(guess));
  double step = 1;
  double low = minimum - 1;  // not enough, as far as is known
  double high = n;
  if (enough(n)) {
    while (high > minimum) {
      const double next = std::max(minimum, high - step);
      if (!enough(next)) {
        low = next;
        break;
      }
      high = next;
      step *= 4;
    }
  } else {
    for (low = n; !enough(high = low + step); step *= 4) {
      low = high;
      if (high > most_samples) return std::nullopt;
    }
  }
  while (high - low > 1) {
    const double middle = std::floor((low + high) / 2);
    (enough(middle) ? high : low) = middle;
  }
  return static_cast<std::uint64_t>(high);
}

// The smallest x > from at which `enough(x)`, to 1e-12 relative; infinite when there is none.
template <class Enough>
double smallest_effect(const Enough& enough, double from, double first_step) {
  double low = from;
  double step = first_step;
  while (!enough(from + step)) {
    low = from + step;
    step *= 2;
    if (!(from + step < 1e300)) return std::numeric_limits<double>::infinity();
  }
  double high = from + step;
  while (high - low > 1e-12 * high) {
    const double middle = std::midpoint(low, high);
    if (middle == low || middle == high) break;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

inline void check_effect(const char* function, double allow, double detect) {
  check::non_negative({function, "allow"}, allow);
  check::finite({function, "detect"}, detect);
  if (!(detect > allow)) check::fail({function, "detect"}, detect, "above allow");
}

}  // namespace assay::stats::planning
