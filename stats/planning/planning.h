#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "stats/basics/check.h"
#include "stats/basics/search.h"
#include "stats/planning/power.h"
#include "stats/tails/tails.h"

namespace assay::stats::planning {

// Internal: planning code that the methods share.

inline void check_rates(const char* function, const ErrorRates& rates) {
  check::inside_unit({function, "alpha"}, rates.alpha);
  check::inside_unit({function, "beta"}, rates.beta);
}

inline LogTail critical_tail(const ErrorRates& rates) {
  return {Tail::upper, std::log(rates.two_sided ? rates.alpha / 2 : rates.alpha)};
}

constexpr double most_samples = 0x1p53;

// The smallest whole n >= minimum at which `enough(n)`, which must be monotone. It gallops from a
// guess, which is often exact, with steps that grow fourfold.
template <class Enough>
std::optional<std::uint64_t> smallest_sample(const Enough& enough, double guess, double minimum) {
  double n = std::max(minimum, std::floor(guess));
  double step = 1;
  double low = minimum - 1;  // Not enough, as far as is known.
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

// The smallest x > from at which an increasing power is as large as wanted. Infinite if there is
// none.
template <class Power>
double smallest_effect(const Power& power, double wanted, double from, double first_step) {
  double low = from, high = from + first_step;
  for (double step = first_step; power(high) < wanted; high = from + step) {
    low = high;
    step *= 2;
    if (!(from + step < 1e300)) return std::numeric_limits<double>::infinity();
  }
  return root_bracket([&](double x) { return power(x) - wanted; }, low, high, 40).second;
}

inline void check_effect(const char* function, double allow, double detect) {
  check::non_negative({function, "allow"}, allow);
  check::finite({function, "detect"}, detect);
  if (!(detect > allow)) check::fail({function, "detect"}, detect, "above allow");
}

}  // namespace assay::stats::planning
