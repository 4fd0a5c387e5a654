#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "stats/tails/smirnov.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// The law that a sample is held against. `cdf(x)` is P(X <= x); where the law has atoms,
// `left_limit` gives P(X < x) (empty: no atoms). Both are clamped to nothing: values outside [0, 1]
// throw. `of_sorted`, where there is one, gives the cdf at all of some ascending values at once.
struct ContinuousLaw {
  std::function<double(double)> cdf;
  std::function<double(double)> left_limit = {};
  std::function<std::vector<double>(std::span<const double>)> of_sorted = {};
};

// F(x_i) of a continuous law at the values of a sorted sample, in its order: for whoever has worked
// them out already.
struct Probabilities {
  std::span<const double> of_values;
};

// F at each of the values. Throws std::domain_error: a value outside [0, 1].
std::vector<double> probabilities(std::span<const double> sorted, const ContinuousLaw& law);

struct OneSampleDistance {
  double distance = 0;
  std::uint64_t n = 0;
  double location = 0;  // the value at which the distance is attained
};

struct TwoSampleDistance {
  LatticeDistance lattice;
  double location = 0;
  std::uint64_t ties = 0;  // values that occur in both samples or twice in one; 0: exact p-value

  double distance() const { return lattice.value(); }
};

// D = max over i of max(i/n - F(x_i), F(x_i-) - (i-1)/n). The values must be sorted ascending
// (std::sort) and finite. Throws std::domain_error: empty, unsorted, non-finite, cdf outside [0,
// 1].
OneSampleDistance ks_distance(std::span<const double> sorted, const ContinuousLaw& law);
// Throws besides: another number of probabilities than of values.
OneSampleDistance ks_distance(std::span<const double> sorted, Probabilities at);

// One merging pass over two sorted samples; no allocation. Throws as above.
TwoSampleDistance ks_distance(std::span<const double> sorted_x, std::span<const double> sorted_y);

// Null hypothesis: the sample follows the law (the two samples one law), i.e. true distance = 0.
// log_p_upper is the p-value; log_p_lower is 0 (a fit that is too good is not tested here).
// One-sample: exact for continuous laws, conservative with atoms. Two-sample: exact without ties,
// conservative with them; Exactness says where the limit law had to serve (smirnov.h).
TestResult kolmogorov_smirnov(const OneSampleDistance& distance);
TestResult kolmogorov_smirnov(const TwoSampleDistance& distance);

// A null value for the true distance Delta = sup |F - F0| (or sup |F - G|), 0 <= null_distance < 1.
//   log_p_upper rejects "Delta <= null_distance" when D is far above it: D - Delta <= sup |F_n -
//   F|,
//     so p = P(sup |F_n - F| >= D - null_distance), exact law for one sample; for two, the sum of
//     two independent suprema, each bounded by Massart's form of Dvoretzky, Kiefer & Wolfowitz
//     (1990).
//   log_p_lower rejects "Delta >= null_distance" when D is far below it: at a point where the laws
//   are
//     null_distance apart the empirical ones must have come within D, so by Hoeffding (1963,
//     theorem 2) p <= exp(-2 n (null_distance - D)^2), n replaced by m n / (m + n) for two samples.
// Both are valid for every n and every law, ties and atoms included.
TestResult ks_margin(const OneSampleDistance& distance, double null_distance);
TestResult ks_margin(const TwoSampleDistance& distance, double null_distance);

// Central interval of Delta: the null distances that ks_margin rejects in neither direction at
// (1 - confidence) / 2 each, within [0, 1].
Interval ks_interval(const OneSampleDistance& distance, double confidence);
Interval ks_interval(const TwoSampleDistance& distance, double confidence);

}  // namespace assay::stats
