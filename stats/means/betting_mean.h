#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/means/student_t.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// Values in ascending order, summarised in cells. A cell at rank r from the nearer end has r / 32
// values, so that 128 values or fewer have one each. Equal values share a cell. There are at most
// 64 ln(n / 64) + 128 cells.
class ValueCells {
 public:
  struct Cell {
    double least = 0;
    double largest = 0;
    double count = 0;
    double at_largest = 0;  // Sum of (value - least) / (largest - least), or 0.
  };

  // Throws std::domain_error: no values, or one that is not finite.
  explicit ValueCells(std::span<const double> values);

  std::span<const Cell> cells() const { return cells_; }
  double count() const { return count_; }
  double mean() const { return mean_; }
  // An imagined value with this weight, in units of observations.
  void add(double value, double weight);

 private:
  std::vector<Cell> cells_;
  double count_ = 0;
  double mean_ = 0;
};

// Fixed bets: 1 - 2^-10, 7/8, 11/16 of the wealth, then 2^-1 to 2^-20 of it.
inline constexpr std::size_t bet_count = 23;

// Null hypothesis: E (x_i | past) = null_mean, for values in a declared range and any n. It assumes
// nothing of their law. Against "E x <= m" the wealth of constant bets l_k is mixed:
//   E = (1 / 23) sum_k prod_i (1 + l_k (x_i - m) / (m - low)).
// Under the null E is a non-negative supermartingale that begins at 1. So p = min(1, 1 / E) is
// valid at every look, however the looks are chosen (Ville 1939; Waudby-Smith & Ramdas 2024, J. R.
// Statist. Soc. B 86; Orabona & Jun 2024). The tail against "E x >= m" is the mirror image at high.
// A tail whose end of the range is infinite has p = 1. A rare value may make up for any difference
// there (Bahadur & Savage 1956).
//
// The logarithm of a bet's wealth is concave in the value. The chord between a cell's ends bounds
// it from below, so p stays valid; it is exact where a cell has one value. (measurements.md has the
// loss.)
//
// The best bet is about (E x - m) (m - low) / Var x. A bet off by sqrt 2 keeps .83 of its growth.
// The statistic is mean - null_mean; its law is "bound". A null mean outside the range is
// impossible: the tail that rejects it has the lowest logarithm. So has a null mean at an end if a
// value differs from it. Throws std::domain_error: an empty range, values beyond it by more than
// rounding, a non-finite null mean.
TestResult betting_mean(const ValueCells& x, Range range, double null_mean);

// Null hypothesis: E x - scale E y = offset, for values in declared ranges. Both samples must speak
// against "E x - scale E y <= d", on either side of one number s:
//  `p = 2 min_s max(p of "E x <= s", p of "scale E y + d >= s")`.
// Under the null, one of the two is true for each s. The p of each is smallest at its own truth. So
// the minimum is no less than the smaller of two valid p-values, at every look. The
// number s is found to 2^-20 of its range. The statistic is mean x - scale mean y - offset. Throws
// as above.
TestResult betting_contrast(const ValueCells& x, Range of_x, const ValueCells& y, Range of_y,
                            Contrast null_value);

// The logarithm of a bet's wealth after one value, over the law of the values moved by `shift`.
struct BetGrowth {
  double mean = 0;
  double variance = 0;
};
// For the bet against "E x <= null", with the end of the range at `null - room`.
struct MovedLaw {
  const ValueCells& values;
  double sign = 1;      // -1 mirrors the values.
  double distance = 0;  // Their mean less the null mean.
  double room = 1;
};
BetGrowth bet_growth(const MovedLaw& law, std::size_t index);

// True if fewer than 32 values lie beyond half the way from their mean to an end of the range.
// Another sample may then have none there.
bool may_hide_values(std::span<const double> values, double mean, double end);

}  // namespace assay::stats
