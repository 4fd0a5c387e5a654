#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace assay::stats {

// So many observations make a group.
inline constexpr std::uint64_t variance_group = 8;

// Turns the variances of several channels, added, into observations. The value of a group is the
// sum over the channels of its sample variance. Groups are independent, and their expectation is
// exactly the total variance, whatever the covariance. Their mean and standard error need no
// covariance matrix, second pass or pilot mean. The price is one degree of freedom in 8.
class GroupVariance {
 public:
  // No channels: computes nothing.
  explicit GroupVariance(std::vector<std::size_t> channels)
      : channels_(std::move(channels)), means_(channels_.size()) {}

  // Takes the next observation. Returns the group's value if it is complete and all its values are
  // finite.
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
  double squares_ = 0;  // Sum over the channels.
  std::uint64_t count_ = 0;
};

}  // namespace assay::stats
