#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace assay::stats {

// Distinct values that occur in one pattern: so many, where independent values would show at most
// `limit` beside those that occur once less and once more.
struct RecurringValues {
  std::size_t times = 0;
  std::size_t values = 0;
  std::size_t limit = 0;
};

// Values that occur equally often: what a file leaves that was written k times and shuffled. For
// independent values of one law, whatever its atoms, N_k, the number of values that occur exactly k
// times among n, has E N_k = C(n, k) sum p^k (1 - p)^(n - k), so that E N_k / C(n, k) are moments
// of one positive measure and, by Cauchy and Schwarz,
//   (E N_k)^2 <= (k + 1) (n - k + 1) / (k (n - k)) E N_(k-1) E N_(k+1)     for k >= 2:
// values that occur k times come with such as occur once less and once more. Returned is the k
// whose N_k is beyond this by most: where the likelihood of (N_(k-1), N_k, N_(k+1)) under the bound
// is below 1e-5, divided among the k that occur, of that without it. Equal values that follow each
// other count as one, so that a chain that rejects its proposals is no recurrence; nor are sorted
// copies, which gates of correlation tell. Values resampled with replacement are independent values
// of a discrete law and cannot be told from them. O(n log n) time. Good 1953 ("The population
// frequencies of species") has the moments.
std::optional<RecurringValues> recurring_values(std::span<const double> values);

// The same of values that occur once in each of two samples, beside those that occur twice in one
// and never in the other: E N_11 <= 2 sqrt(n m / ((n - 1) (m - 1)) E N_20 E N_02), whatever the two
// laws. `times` is 1.
std::optional<RecurringValues> shared_values(std::span<const double> first,
                                             std::span<const double> second);

}  // namespace assay::stats
