#include "stats/cells/chi_square_effect.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// Larger than the reciprocal root of any cell's probability: counts as infinite.
constexpr double largest_effect = 1e12;

LogTails effect_tails(const ChiSquareStatistic& statistic, double effect) {
  return noncentral_chi_square_tails(
      statistic.value, {statistic.degrees_of_freedom, statistic.observations * effect * effect});
}

}  // namespace

double ChiSquareStatistic::effect() const {
  return std::sqrt(std::max(0.0, value - degrees_of_freedom) / observations);
}

TestResult chi_square_effect(const ChiSquareStatistic& statistic, double null_effect) {
  check::non_negative({"chi_square_effect", "null_effect"}, null_effect);
  const LogTails tails = effect_tails(statistic, null_effect);
  return {statistic.value,
          {"noncentral-chi-square",
           {statistic.degrees_of_freedom, statistic.observations * null_effect * null_effect}},
          tails.lower,
          tails.upper,
          Exactness::asymptotic};
}

Interval chi_square_effect_interval(const ChiSquareStatistic& statistic, double confidence) {
  const double start = statistic.effect() + 1 / std::sqrt(statistic.observations);
  return effect_interval([&](double w) { return effect_tails(statistic, w); }, start, confidence);
}

Interval effect_interval(const std::function<LogTails(double)>& tails, double start,
                         double confidence) {
  check::inside_unit({"effect_interval", "confidence"}, confidence);
  const double log_tail = std::log((1 - confidence) / 2);
  // Both tails are monotone in w. The low end is 0 when even w = 0 is not rejected from that side.
  const auto end = [&](auto excess) {
    if (excess(0.0) >= 0) return 0.0;
    double high = start;
    while (excess(high) < 0 && high < largest_effect) high *= 2;
    if (high >= largest_effect) return std::numeric_limits<double>::infinity();
    std::uintmax_t iterations = 200;
    const auto ends = boost::math::tools::toms748_solve(
        excess, 0.0, high, boost::math::tools::eps_tolerance<double>(44), iterations);
    return std::midpoint(ends.first, ends.second);
  };
  if (tails(0).lower < log_tail) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, confidence};
  }
  return {end([&](double w) { return tails(w).upper - log_tail; }),
          end([&](double w) { return log_tail - tails(w).lower; }), confidence};
}

}  // namespace assay::stats
