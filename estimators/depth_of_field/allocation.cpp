#include "depth_of_field/allocation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace assay::depth_of_field {

namespace {

std::vector<std::uint64_t> counts(std::span<const double> shares, double scale) {
  std::vector<std::uint64_t> out;
  for (const double share : shares) {
    out.push_back(static_cast<std::uint64_t>(std::max(1.0, std::round(scale * share))));
  }
  return out;
}

double total(const std::vector<std::uint64_t>& counts) {
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
}

}  // namespace

std::vector<std::uint64_t> lens_counts(std::span<const double> variances, const Allocation& plan) {
  std::vector<double> shares;
  for (const double v : variances) shares.push_back(std::pow(v, plan.exponent));
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (!(sum > 0)) return counts(shares, 0);
  const double budget = plan.mean_count * static_cast<double>(shares.size());
  double low = 0;
  double high = 2 * budget / sum;  // more than the budget, whatever is rounded down to one
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (total(counts(shares, middle)) <= budget ? low : high) = middle;
  }
  return counts(shares, low);
}

}  // namespace assay::depth_of_field
