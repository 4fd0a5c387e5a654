#pragma once

#include <memory>
#include <optional>

#include "stats/means/betting_mean.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// One sample's data as tests of means take them.
struct MeanSample {
  Moments moments;
  Range range;
  double rounding = 0;                                // Bound on the values' rounding.
  std::shared_ptr<const ValueCells> cells = nullptr;  // The values, for bets.
};

// Tests "E x = value", and "E x - scale E y = offset".
struct MeanTest {
  TestResult (*of_one)(const MeanSample& x, const Reference& null);
  TestResult (*of_two)(const MeanSample& x, const MeanSample& y, const Contrast& null);
  bool bets = false;
};

// student_t and welch_t; the same with Hall's correction; counts of two values; bets. An exact test
// of a value that is known up to an error is maximised over it (uncertain_reference.h). Of rounded
// values each tail of a bet is that of the nearest null.
extern const MeanTest mean_by_t;
extern const MeanTest mean_by_corrected_t;
extern const MeanTest mean_by_counts;
extern const MeanTest mean_by_bets;

// theta = E x - r - offset, or that over |r| if it is relative. The reference r is a number, or
// scale E y. Where theta is relative to E y, y must show its sign too. It decides which contrast a
// margin is.
struct ThetaOfMeans {
  const MeanTest& test;
  MeanSample x;
  std::optional<MeanSample> y = {};
  Reference reference = {};
  Contrast contrast = {};
  bool relative = false;

  // Throws std::domain_error for fewer than two values, which have no error.
  double estimate() const;
  // Null hypothesis: theta is this value. Throws as the test does.
  TestResult at(double theta) const;
  // The values that `at` does not reject. Of a ratio of means it is Fieller's (1954), with Welch's
  // degrees of freedom. It has no ends if y does not show its sign, and for a unit of 0.
  Interval interval(double confidence) const;
  // All three, of a copy.
  Evidence evidence() const;

 private:
  double unit() const;
};

}  // namespace assay::stats
