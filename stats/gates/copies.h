#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace assay::stats {

// Values [first, first + length) are values [second, second + length), bit for bit.
struct RepeatedRun {
  std::size_t first = 0;
  std::size_t second = 0;
  std::size_t length = 0;
};

// A run that occurs a second time and is too long for chance, as from a program started twice with
// one seed. For independent values of one law, a given run with k changes from one value to the
// next has probability at most 2^-k. A change from a to b takes p_a p_b <= 1/4, and each value is
// in at most two changes.
//
// A run with k >= log2(n (n - 1) / 2) + log2(10^5) changes occurs twice with probability at most
// 1e-5. Values that stay do not count, so neither rare events nor rejected proposals look repeated.
// A run of only two values does not count: a chain of two states can but alternate.
//
// The run is returned at its full length; its two places may overlap. It may escape if half of its
// changes are between two values alone, or lack a change at either end. O(n) time; memory for the
// changes.
std::optional<RepeatedRun> repeated_run(std::span<const double> values);

// The same for one sample's values in another's, over all n m pairs of places.
std::optional<RepeatedRun> common_run(std::span<const double> first,
                                      std::span<const double> second);

}  // namespace assay::stats
