#pragma once

#include <cstddef>
#include <span>
#include <vector>

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

  // Those of them that `counts` and that vary.
  void add(std::span<const Cumulants> cells, const std::vector<bool>& counts, std::size_t first);

  double count() const { return count_; }
  double factor() const { return sum_ / count_; }
  double excess() const { return excess_ / count_; }  // that scatter alone gives

 private:
  double scale_;
  double count_ = 0;
  double sum_ = 0;
  double excess_ = 0;
};

}  // namespace assay::stats
