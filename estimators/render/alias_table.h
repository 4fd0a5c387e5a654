#pragma once

#include <cstddef>
#include <vector>

namespace assay::render {

/// Draws an index with probability proportional to its weight in constant time (Walker 1977, set up
/// as by Vose 1991).
class AliasTable {
 public:
  /// std::invalid_argument unless the weights are finite, not negative and of positive sum.
  explicit AliasTable(const std::vector<double>& weights);

  double total() const { return total_; }
  /// The index for u and v uniform in [0, 1). Never one of weight zero.
  std::size_t pick(double u, double v) const {
    const std::size_t column = static_cast<std::size_t>(u * static_cast<double>(columns_.size()));
    const Column& c = columns_[column < columns_.size() ? column : columns_.size() - 1];
    return v < c.share ? c.own : c.alias;
  }

 private:
  /// One of n equal parts of the unit interval: `own` below `share`, `alias` above.
  struct Column {
    double share = 1;
    std::size_t own = 0;
    std::size_t alias = 0;
  };

  double total_ = 0;
  std::vector<Column> columns_;
};

}  // namespace assay::render
