#pragma once

#include <optional>
#include <span>

#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

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
// kolmogorov_smirnov of all. Exact and conservative; exactness is that of kolmogorov_smirnov.
// `distance` is that of the samples. Throws std::domain_error as ks_distance does.
TwoLawsTest two_part_ks(std::span<const double> sorted_x, std::span<const double> sorted_y,
                        const TwoSampleDistance& distance);

}  // namespace assay::stats
