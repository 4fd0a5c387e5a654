#pragma once

#include <span>

namespace assay::stats {

// Internal to cell_tails: cumulants of the numerator of a studentised sum.
struct Cumulants {
  double variance = 0;
  double third = 0;
  double third_variance = 0;  // of the estimate of `third`, were the law normal
};

// Sums over many cells of the factors of image_cell_skewness.h at one critical value x.
class LevelFactors {
 public:
  explicit LevelFactors(double x) : scale_(x * x * x / 3) {}

  // Those of them that vary.
  void add(std::span<const Cumulants> cells);
  // As if the other's had been added here.
  void merge(const LevelFactors& other);

  double count() const { return count_; }
  double factor() const { return sum_ / count_; }
  double excess() const { return excess_ / count_; }  // that scatter alone gives
  // The mean of the cells' skewnesses, with its sign, less what scatter alone gives it with
  // probability 1e-4. Every cell is counted `copies` times, which may depend on each other.
  double common_skewness(double copies) const;
  double factor_of(double skewness) const;

 private:
  double scale_;
  double count_ = 0;
  double sum_ = 0;
  double excess_ = 0;
  double arguments_ = 0;  // c g, with its sign
  double scatters_ = 0;   // their variances
};

}  // namespace assay::stats
