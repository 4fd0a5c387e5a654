#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace assay::render {

/// Picks an index with probability proportional to its share. Shares are not negative; their sum is
/// positive.
class ShareTable {
 public:
  explicit ShareTable(const std::vector<double>& shares) {
    for (const double share : shares) total_ += share;
    double sum = 0;
    for (const double share : shares) {
      const double begin = sum / total_;
      const double end = (sum += share) / total_;
      shares_.push_back({begin, end, 1 / (end - begin)});
    }
  }

  double total() const { return total_; }
  /// Maps x uniform in [0, 1) to an index and to x uniform again: its place within the share. With
  /// one index x stays what it is. No index of share 0 is picked.
  std::uint32_t pick(double& x) const {
    if (shares_.size() == 1) return 0;
    const std::uint32_t index = find(x);
    x = std::min((x - shares_[index].begin) * shares_[index].scale, 1.0);
    return index;
  }

  /// An index and a point of the unit square, uniform, for a place within the share.
  struct Choice {
    std::uint32_t index;
    double u;
    double v;
  };
  /// Picks by two numbers of a stream.
  template <class Random>
  Choice choose(Random& random) const {
    double u = random.uniform();
    const double v = random.uniform();
    const std::uint32_t index = pick(u);
    return {index, u, v};
  }

 private:
  struct Share {
    double begin;  // as a fraction of the total
    double end;
    double scale;  // 1 / (end - begin)
  };

  std::uint32_t find(double x) const {
    if (shares_.size() > 8) {
      const auto share = std::ranges::upper_bound(shares_, x, {}, &Share::end);
      return static_cast<std::uint32_t>(share - shares_.begin());
    }
    // Counted rather than searched: the processor cannot foresee where a search ends.
    std::uint32_t index = 0;
    for (std::size_t i = 0; i + 1 < shares_.size(); ++i) index += x >= shares_[i].end;
    return index;
  }

  std::vector<Share> shares_;
  double total_ = 0;
};

}  // namespace assay::render
