#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stats/basics/moments.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// A quantile of a law is any number v with P(X < v) <= probability <= P(X <= v). Two counts say all
// that a sample knows about it. No density is needed, and atoms and ties are allowed.
struct QuantileCounts {
  std::uint64_t below = 0;    // Values < v.
  std::uint64_t at_most = 0;  // Values <= v.
  std::uint64_t n = 0;
};
QuantileCounts count_around(std::span<const double> sorted, double value);

// Null hypothesis: v is the quantile of this probability (Thompson 1936). The p-values are
//   log_p_lower = ln P(Binomial(n, probability) >= below) rejects "quantile >= v".
//   log_p_upper = ln P(Binomial(n, probability) <= at_most) rejects "quantile <= v".
// Exact for every law, conservative if X = v has positive probability. The statistic is probability
// - (below + at_most) / 2n, positive when the sample's quantile lies above v. Its tails are
// binomial. Throws std::domain_error: n = 0, below > at_most, at_most > n, probability outside (0,
// 1).
TestResult quantile_test(const QuantileCounts& counts, double probability);

// Central interval of the quantile: two order statistics, or infinite if the sample is too small.
// Each value outside is rejected by quantile_test at (1 - confidence) / 2. Values must be sorted
// ascending and finite (std::domain_error).
Interval quantile_interval(std::span<const double> sorted, double probability, double confidence);

// Index of the sample quantile in sorted values, at least one: floor(q n), for q = 1 the last.
std::size_t sample_quantile_rank(std::size_t count, double probability);

// Null hypothesis: Q(x) = Q(y) + offset for the quantiles Q of one probability, independent
// samples. Take the hypothesis Q(x) <= Q(y) + offset. It says that some v lies between the two
// sides. So it is rejected if every v is. The exact p-values of the two inequalities at v are
// independent. Their product c has P(c <= a) <= a (1 - ln a) (Fisher 1932). The largest over v is
// the p-value. Exact and conservative (law "bound"). The statistic is the difference of the two
// sample quantiles.
TestResult quantile_compare(std::span<const double> sorted_x, std::span<const double> sorted_y,
                            double probability, double offset = 0);

// Central interval of Q(x) - Q(y): the offsets not rejected, by bisection to double precision. Ends
// are infinite if no offset is rejected.
Interval quantile_difference_interval(std::span<const double> sorted_x,
                                      std::span<const double> sorted_y, double probability,
                                      double confidence);

// Evidence about theta = (quantile - null) / unit, unit > 0, and about theta = Q(x) - Q(y). Values
// are sorted.
Evidence quantile_evidence(std::vector<double> sorted, double probability, double null,
                           double unit);
Evidence quantile_evidence(std::vector<double> sorted_x, std::vector<double> sorted_y,
                           double probability);

// Standard deviation of one observation in the normal limit of a sample quantile, sqrt(q (1 - q)) /
// density (Mosteller 1946). Pass it to normal_sample_size to plan in units of the value. Throws
// std::domain_error for a probability outside (0, 1) and a density that is not positive.
double quantile_standard_deviation(double probability, double density);

// These estimate the density at the quantile. If it differs, the planned size is off by its ratio.

// The same with the density that a sample shows over `distance` on the quantile's sparser side,
// less two of its standard errors. Near an end of the sample its 128 outermost values tell it.
// Their excesses over the next value count as generalised Pareto, by mean and variance (Hosking &
// Wallis 1987). Nothing for fewer than 256 finite values, or if the density does not show.
std::optional<double> observed_quantile_deviation(std::span<const double> sample,
                                                  double probability, double distance);

// The same for means of `averaged` values with these moments. Their density is normal, stretched by
// Cornish and Fisher's first term to a fifth at least.
double quantile_deviation_of_means(const Moments& values, double averaged, double probability);

}  // namespace assay::stats
