#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace assay::stats {

// ---- Copies in order

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

// ---- Shuffled copies

// Distinct values that occur in one pattern. `limit` is the most that independent values would show
// beside those that occur once less and once more.
struct RecurringValues {
  std::size_t times = 0;
  std::size_t values = 0;
  std::size_t limit = 0;
};

// Finds values that occur equally often, as in a file that was written k times and shuffled. Let
// N_k be the number of values that occur exactly k times among n independent values of one law.
// Then E N_k = C(n, k) sum p^k (1 - p)^(n - k), atoms or not. So E N_k / C(n, k) are moments of one
// positive measure (Good 1953). For k >= 2 Cauchy and Schwarz give
//   (E N_k)^2 <= (k + 1) (n - k + 1) / (k (n - k)) E N_(k-1) E N_(k+1).
//
// Returned is the k whose N_k is farthest beyond this. The likelihood of (N_(k-1), N_k, N_(k+1))
// under the bound must be below 1e-5 of that without it, divided among the k that occur. Equal
// values that follow each other count as one, so a chain that rejects its proposals is no
// recurrence. Sorted copies and values resampled with replacement are not found. O(n log n) time.
std::optional<RecurringValues> recurring_values(std::span<const double> values);

// The same for values that occur once in each of two samples. They are held against those that
// occur twice in one and never in the other. For any two laws E N_11 <= 2 sqrt(n m / ((n - 1) (m -
// 1)) E N_20 E N_02). `times` is 1.
std::optional<RecurringValues> shared_values(std::span<const double> first,
                                             std::span<const double> second);

}  // namespace assay::stats
