#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "stats/tails/kolmogorov.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// The law that a sample is held against: P(X <= x) at x. Values outside [0, 1] throw.
using ContinuousLaw = std::function<double(double)>;

struct OneSampleDistance {
  double distance = 0;
  std::uint64_t n = 0;
};

struct FrequentValue {
  double value = 0;
  std::uint64_t count = 1;
};

struct TwoSampleDistance {
  LatticeDistance lattice;
  std::vector<TiedRun> ties = {};    // Equal values of both samples together.
  FrequentValue most_frequent = {};  // Of both together; the first of several.

  double distance() const { return lattice.value(); }
};

// D = max over i of max(i/n - F(x_i), F(x_i) - (i-1)/n). The values must be sorted ascending and
// finite. Throws std::domain_error: empty, unsorted, non-finite, cdf outside [0, 1].
OneSampleDistance ks_distance(std::span<const double> sorted, const ContinuousLaw& law);

// One merging pass over two sorted samples. It allocates for ties alone. Throws as above.
TwoSampleDistance ks_distance(std::span<const double> sorted_x, std::span<const double> sorted_y);

// Null hypothesis: the sample follows the law (the two samples one law). The p-value is
// log_p_upper; log_p_lower is 0, because a fit that is too good is not tested. One sample: exact
// for continuous laws. Two samples: exact for every law, given the ties of
// both together. kolmogorov.h says where a bound or the limit law has to serve.
TestResult kolmogorov_smirnov(const OneSampleDistance& distance);
TestResult kolmogorov_smirnov(const TwoSampleDistance& distance);

// A null value for the true distance Delta = sup |F - F0| (or sup |F - G|), 0 <= null_distance < 1.
// Both p-values are valid for every n and every law, ties and atoms included.
//
// log_p_upper rejects "Delta <= null_distance" when D is far above it. D - Delta <= sup |F_n - F|,
// so p = P(sup |F_n - F| >= D - null_distance). For one sample that law is exact. For two it is the
// sum of two independent suprema. Massart's form of Dvoretzky, Kiefer & Wolfowitz (1990) bounds
// each.
//
// log_p_lower rejects "Delta >= null_distance" when D is far below it. Where the laws are
// null_distance apart, the empirical ones must have come within D. So p <= exp(-2 n (null_distance
// - D)^2) by Hoeffding (1963, theorem 2). For two samples m n / (m + n) replaces n.
TestResult ks_margin(const OneSampleDistance& distance, double null_distance);
TestResult ks_margin(const TwoSampleDistance& distance, double null_distance);

// ---- Two samples with a frequent value

// A value that many of both samples share: a black pixel, a clamped value.
struct CommonValue {
  double value = 0;
  double difference = 0;  // The shares of the two samples differ by so much, without sign.
  bool decides = false;   // True if p is that of its counts.
};

struct TwoLawsTest {
  TestResult result;
  std::optional<CommonValue> common = {};
};

// Share of both samples together from which on their most frequent value is tested apart.
inline constexpr double least_common_share = 0.01;

// Null hypothesis: two independent samples of one law, continuous or not. The test is a permutation
// test given the values of both together, so a value may be chosen from them. If the most frequent
// value makes up `least_common_share` or more, it is tested apart. Fisher's exact test (1935)
// compares its counts. Given these, kolmogorov_smirnov compares the other values. The parts are
// exact, and the smaller p-value counts twice (Bonferroni). Without such a value it is
// kolmogorov_smirnov of all. Exact as far as kolmogorov_smirnov is, and conservative.
// `distance` is that of the samples. Throws std::domain_error as ks_distance does.
TwoLawsTest two_part_ks(std::span<const double> sorted_x, std::span<const double> sorted_y,
                        const TwoSampleDistance& distance);

}  // namespace assay::stats
