#pragma once

#include <cmath>
#include <span>

namespace assay::stats {

// Internal to cell_tails: cumulants of the numerator of a studentised sum.
struct Cumulants {
  double variance = 0;
  double third = 0;
  double third_variance = 0;  // of the estimate of `third`, were the law normal
};

// Of factor times the mean of so many replicates, from moments of `count` values: sums of the
// second and third powers of their deviations from their mean. m2 > 0.
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

  // Those of them that vary.
  void add(std::span<const Cumulants> cells);
  // As if the other's had been added here.
  void merge(const LevelFactors& other);

  double count() const { return count_; }
  double factor() const { return sum_ / count_; }
  double excess() const { return excess_ / count_; }  // that scatter alone gives
  // The larger of two, with their signs, each less what scatter alone gives it with probability
  // 1e-4: the mean of the cells' skewnesses, and that of the law whose third cumulant and variance
  // are the means of theirs. Where each cell seldom meets what skews it (fireflies), most have not,
  // and the first sees nothing. Every cell is counted `copies` times, which may depend on each
  // other.
  double common_skewness(double copies) const;
  double factor_of(double skewness) const;

 private:
  double scale_;
  double count_ = 0;
  double sum_ = 0;
  double excess_ = 0;
  double arguments_ = 0;  // c g, with its sign
  double scatters_ = 0;   // their variances
  Cumulants cells_ = {};  // summed
};

}  // namespace assay::stats
