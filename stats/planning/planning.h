#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "stats/basics/check.h"
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

// The normal score of a power 1 - miss. It is finite also where miss rounds to 0 or 1.
inline double score_of_miss(double miss) {
  return upper_normal_quantile(std::clamp(miss, 1e-300, 1 - 1e-15));
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

struct Bracket {
  double low = 0;  // Not enough.
  double high = 0;
};

// Bracket around the smallest x > from at which `enough(x)`, to 1e-12 relative. Infinite if there
// is none.
template <class Enough>
Bracket effect_bracket(const Enough& enough, double from, double first_step) {
  Bracket found{from, from + first_step};
  for (double step = first_step; !enough(found.high); found.high = from + step) {
    found.low = found.high;
    step *= 2;
    if (!(from + step < 1e300)) {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      return {infinity, infinity};
    }
  }
  while (found.high - found.low > 1e-12 * found.high) {
    const double middle = std::midpoint(found.low, found.high);
    if (middle == found.low || middle == found.high) break;
    (enough(middle) ? found.high : found.low) = middle;
  }
  return found;
}

template <class Enough>
double smallest_effect(const Enough& enough, double from, double first_step) {
  return effect_bracket(enough, from, first_step).high;
}

// The same bits where a good guess is known. It tries the bracket that halving would end with if
// the guess were right: two questions in place of forty.
template <class Enough>
double smallest_effect(const Enough& enough, double from, double first_step, double guess) {
  const Bracket likely = effect_bracket([guess](double x) { return x >= guess; }, from, first_step);
  const bool right = std::isfinite(likely.high) && enough(likely.high) &&
                     (likely.low == from || !enough(likely.low));
  return right ? likely.high : smallest_effect(enough, from, first_step);
}

// An approximate root, and the approximate slope there.
struct Guess {
  double root = 0;
  double slope = 1;
};

// The zero of a nearly linear increasing function, by secants. Each error is a small part of the
// product of the last two steps. If it does not converge it returns some number.
template <class Function>
double secant_root(const Function& function, Guess guess) {
  double before = guess.root;
  double old = function(before);
  double step = -old / guess.slope;
  double at = before + step;
  double previous = 1e-3 * std::abs(at);
  for (int round = 0; round < 8 && !(std::abs(step * previous) <= 1e-13 * at * at); ++round) {
    const double value = function(at);
    previous = std::exchange(step, -value * step / (value - old));
    old = value;
    at += step;
  }
  return at;
}

inline void check_effect(const char* function, double allow, double detect) {
  check::non_negative({function, "allow"}, allow);
  check::finite({function, "detect"}, detect);
  if (!(detect > allow)) check::fail({function, "detect"}, detect, "above allow");
}

}  // namespace assay::stats::planning
