#pragma once

#include <functional>
#include <string>
#include <vector>

namespace assay::stats {

// The law of a statistic under the null hypothesis, by name and parameters.
//  `"normal" {}, "student-t" {nu}, "chi-square" {nu}, "F" {nu1, nu2}, "binomial" {n, p},
//   "noncentral-chi-square" {nu, ncp}, "kolmogorov" {n}, "smirnov" {m, n}, "bound" {},
//   "image-family" {sums}`.
// A "bound" is a probability inequality: the p-value is an upper bound, the statistic has no law.
// An "image-family" has the smallest p-value of so many sums over an image.
struct Distribution {
  std::string family;
  std::vector<double> parameters;
};

// One statistic S and its two one-sided p-values, as natural logarithms. They are always finite:
// the most negative finite double stands for smaller values. A method is exact if P(p <= a) <= a
// for every sample size, under its stated assumptions. It is asymptotic if that holds in the limit
// of large samples.
struct TestResult {
  double statistic = 0;
  Distribution distribution;
  // ln P(S <= statistic). Small: rejects "parameter >= null value".
  double log_p_lower = 0;
  // ln P(S >= statistic). Small: rejects "parameter <= null value".
  double log_p_upper = 0;
};

// ln p of the point null: min(0, ln 2 + min(log_p_lower, log_p_upper)).
double log_p_two_sided(const TestResult& result);

// The logarithm of the p-value of two one-sided tests (Schuirmann 1987). Null hypothesis: theta <=
// low or theta >= high. The p is the larger of p of "theta <= low" and p of "theta >= high", from
// any two results of one method at the two null values. Two tests need no factor: P(p <= a) <= a.
double log_p_equivalence(const TestResult& at_low, const TestResult& at_high);

// A central interval: each of the two tails carries (1 - confidence) / 2. So two one-sided tests at
// beta correspond to confidence = 1 - 2 beta. An end may be infinite.
struct Interval {
  double low = 0;
  double high = 0;
  double confidence = 0;
};

// A rough location of an interval.
struct Whereabouts {
  double estimate = 0;
  double step = 1;  // About a standard error.
};

// The values of theta that `at` rejects in neither tail at (1 - confidence) / 2. The ends are exact
// to 1e-12 of their distance from the estimate. An end beyond 60 doublings of the step is infinite.
// `at` must be monotone: its upper tail rejects larger values less.
Interval interval_by_inversion(const std::function<TestResult(double)>& at,
                               const Whereabouts& around, double confidence);

}  // namespace assay::stats
