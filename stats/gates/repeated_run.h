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

// A run that occurs a second time, so long that independent values do not repeat it by chance: what
// a program leaves that was started twice with one seed. Of independent values of one law, whatever
// the law, a given run that changes from one value to the next k times has probability at most
// 2^-k: a change from a to b takes p_a p_b <= 1/4, and each value is in at most two changes. So
// over all n (n - 1) / 2 pairs of places a run with k >= log2(n (n - 1) / 2) + log2(10^5) changes
// occurs twice with probability at most 1e-5; of continuous values none does. Values that stay
// count for nothing, so that neither rare events nor a chain that rejects its proposals look
// repeated, and of two values no run counts: a chain of two states can but alternate. A walk of
// equal chances on a lattice is within the bound too. The run is returned as long as it is, the two
// places overlapping where a short pattern goes on; it may escape where half of its changes are
// between two values alone, or be short of a change at either end. O(n) time; memory for the
// changes.
std::optional<RepeatedRun> repeated_run(std::span<const double> values);

// The same of one sample's values in another's, over all n m pairs of places.
std::optional<RepeatedRun> common_run(std::span<const double> first,
                                      std::span<const double> second);

}  // namespace assay::stats
