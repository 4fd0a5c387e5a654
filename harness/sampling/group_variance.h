#pragma once

// The variances of several channels, added, as observations of their own. Consecutive observations
// are taken in groups of 8; a group's value is the sum over the channels of its sample variance.
// Groups are independent and their expectation is exactly the total variance, whatever the
// covariance of the channels: so the mean over the groups, with the standard error of these values,
// estimates it without a covariance matrix, a second pass or a pilot's mean. The price is one
// degree of freedom in 8: 8/7 as many observations as the full sample variance of normal data
// takes.

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace assay::harness {

/// Blocks are multiples of it, so that no group spans two.
inline constexpr std::uint64_t variance_group = 8;

class GroupVariance {
 public:
  /// Of these channels; of none, nothing is computed.
  explicit GroupVariance(std::vector<std::size_t> channels)
      : channels_(std::move(channels)), means_(channels_.size()) {}

  /// Takes the next observation; the sum of variances where it completes a group, and nothing where
  /// a value of the group was not finite.
  std::optional<double> add(std::span<const double> values) {
    if (channels_.empty()) return {};
    ++count_;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      const double delta = values[channels_[i]] - means_[i];
      means_[i] += delta / static_cast<double>(count_);
      squares_ += delta * (values[channels_[i]] - means_[i]);
    }
    if (count_ < variance_group) return {};
    const double total = squares_ / static_cast<double>(variance_group - 1);
    count_ = 0;
    squares_ = 0;
    means_.assign(means_.size(), 0);
    if (!std::isfinite(total)) return {};
    return total;
  }

 private:
  std::vector<std::size_t> channels_;
  std::vector<double> means_;
  double squares_ = 0;  // summed over the channels
  std::uint64_t count_ = 0;
};

}  // namespace assay::harness
