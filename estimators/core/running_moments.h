#pragma once

// Mean and variance of numbers as they come.

namespace assay {

/// Welford's (1962) recurrence: mean += d / n, squares += d (x - mean), d = x - mean before. The
/// sum of squares is of distances from the mean, so that nothing cancels and it is never negative.
class RunningMoments {
 public:
  void add(double x) {
    ++count_;
    const double before = x - mean_;
    mean_ += before / count_;
    squares_ += before * (x - mean_);
  }
  /// A whole number.
  double count() const { return count_; }
  /// 0 of none.
  double mean() const { return mean_; }
  /// Sample variance, n - 1 in the denominator; NaN of fewer than two.
  double variance() const { return squares_ / (count_ - 1); }

 private:
  double count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
};

}  // namespace assay
