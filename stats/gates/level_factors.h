#pragma once

#include <cmath>
#include <span>

namespace assay::stats {

// Internal to cell_tails: cumulants of the numerator of a studentised sum.
struct Cumulants {
  double variance = 0;
  double third = 0;
  double third_variance = 0;  // Variance of the estimate of `third`, were the law normal.
};

// Cumulants of factor times the mean of `replicates` replicates. The members m2 and m3 are sums of
// the second and third powers of deviations of `count` values from their mean. m2 > 0.
struct MomentsOfMean {
  double m2 = 0;
  double m3 = 0;
  double count = 0;
  double factor = 1;
  double replicates = 1;
};
inline Cumulants cumulants_of_mean(const MomentsOfMean& of) {
  const double deviation = of.factor * std::sqrt(of.m2 / (of.count - 1));
  const double skewness = std::sqrt(of.count / of.m2) * (of.m3 / of.m2);
  const double scale = deviation * deviation * deviation / (of.replicates * of.replicates);
  return {.variance = deviation * deviation / of.replicates,
          .third = scale * skewness,
          .third_variance = 6 / of.count * scale * scale};
}

inline void add_to(Cumulants& sum, const Cumulants& part) {
  sum.variance += part.variance;
  sum.third += part.third;
  sum.third_variance += part.third_variance;
}

// Sums over many cells of the factors of image_cell_skewness.h at one critical value x.
class LevelFactors {
 public:
  explicit LevelFactors(double x) : scale_(x * x * x / 3) {}

  // Adds those cells that vary.
  void add(std::span<const Cumulants> cells);
  // Same as adding the other's cells here.
  void merge(const LevelFactors& other);

  double count() const { return count_; }
  double factor() const { return sum_ / count_; }
  double excess() const { return excess_ / count_; }  // Excess that scatter alone gives.
  // The larger of two skewnesses, with their signs. Each is reduced by what scatter alone gives it
  // with probability 1e-4. One is the mean of the cells' skewnesses. The other is that of the law
  // whose third cumulant and variance are the means of theirs. The second sees skewness that most
  // cells have not met yet (fireflies). Every cell is counted `copies` times, which may depend on
  // each other.
  double common_skewness(double copies) const;
  double factor_of(double skewness) const;

 private:
  double scale_;
  double count_ = 0;
  double sum_ = 0;
  double excess_ = 0;
  double arguments_ = 0;  // c g, with its sign.
  double scatters_ = 0;   // Their variances.
  Cumulants cells_ = {};  // Summed.
};

}  // namespace assay::stats
