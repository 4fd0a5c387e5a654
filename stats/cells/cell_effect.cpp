#include "stats/cells/cell_effect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/basics/check.h"
#include "stats/basics/search.h"

namespace assay::stats {
namespace {

// The data's direction is stretched at most this much to the null effect.
constexpr double most_stretched = 2;

// Larger than the reciprocal root of any cell's probability: counts as infinite.
constexpr double largest_effect = 1e12;

double variance_of(Noncentral law) { return 2 * (law.degrees + 2 * law.noncentrality); }

}  // namespace

CellEffect::CellEffect(std::span<const PooledCell> cells, std::uint64_t observations)
    : n_(static_cast<double>(observations)), cells_(static_cast<double>(cells.size())) {
  check::at_least({"CellEffect", "observations"}, observations, fewest_observations);
  for (const PooledCell& cell : cells) {
    const double p = cell.expected / n_;
    const double count = static_cast<double>(cell.observed);
    const double first = count / n_ / p;
    const double second = first * ((count - 1) / (n_ - 1) / p);
    const double third = second * ((count - 2) / (n_ - 2) / p);
    const double fourth = third * ((count - 3) / (n_ - 3) / p);
    squared_ += p * (second - 2 * first + 1);
    third_ += p * (third - 3 * second + 3 * first - 1);
    fourth_ += p * (fourth - 4 * third + 6 * second - 4 * first + 1);
    sum_ += first - 1;
    sum_squares_ += second - 2 * first + 1;
  }
}

struct CellEffect::AtNull {
  double variance;  // Variance of U.
  double third;     // Third cumulant of n U.
};

CellEffect::AtNull CellEffect::at_null(double null_effect) const {
  const double squared = null_effect * null_effect;
  const double effect = std::max(std::sqrt(std::max(0.0, squared_)), null_effect / most_stretched);
  const double stretch = effect > 0 ? null_effect / effect : 0;
  const double third = third_ * std::pow(stretch, 3);
  const double fourth = std::max(0.0, fourth_) * std::pow(stretch, 4);
  const double linear = std::max(squared, squared + third - squared * squared);
  const double sum = cells_ + 2 * stretch * sum_ + stretch * stretch * sum_squares_;
  const double quadratic = std::max(cells_ - 1, sum - (1 + squared) * (1 + squared));
  const double pairs = n_ * (n_ - 1);
  const double excess = std::max(0.0, n_ * (56 * third + 32 * fourth));
  return {.variance = 4 * (n_ - 2) / pairs * linear + 2 / pairs * quadratic,
          .third = 8 * (cells_ - 1 + 3 * n_ * squared) + excess};
}

// U, moved so that it is as many standard deviations from that law's mean as from its own.
double CellEffect::moved(const AtNull& law, double null_effect, Noncentral to) const {
  const double z = (squared_ - null_effect * null_effect) / std::sqrt(law.variance);
  return std::max(0.0, to.degrees + to.noncentrality + z * std::sqrt(variance_of(to)));
}

double CellEffect::statistic(double null_effect) const {
  return moved(at_null(null_effect), null_effect, {cells_ - 1, n_ * null_effect * null_effect});
}

LogTails CellEffect::tails(double null_effect) const {
  const AtNull law = at_null(null_effect);
  const Noncentral plain{cells_ - 1, n_ * null_effect * null_effect};
  const double skewness =
      8 * (plain.degrees + 3 * plain.noncentrality) / std::pow(variance_of(plain), 1.5);
  const double of_data = law.third / std::pow(n_ * n_ * law.variance, 1.5);
  const double share = of_data > skewness ? std::pow(skewness / of_data, 2) : 1;
  const Noncentral skew{share * plain.degrees, share * plain.noncentrality};
  return {
      .lower = noncentral_chi_square_tails(moved(law, null_effect, plain), plain).lower,
      .upper = noncentral_chi_square_tails(moved(law, null_effect, skew), skew).upper,
  };
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
    return root(excess, {0, high}, 44);
  };
  if (tails(0).lower < log_tail) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, confidence};
  }
  return {end([&](double w) { return tails(w).upper - log_tail; }),
          end([&](double w) { return log_tail - tails(w).lower; }), confidence};
}

}  // namespace assay::stats
