#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace assay::stats {

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
