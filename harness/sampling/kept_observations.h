#pragma once

// Observations that are kept whole.

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "estimators/cost.h"
#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

struct KeptObservations {
  std::vector<std::vector<double>> values = {};       ///< as they were drawn; of pictures none
  std::vector<std::unique_ptr<float[]>> texels = {};  ///< of pictures of files, a block each
  std::vector<std::span<const float>> pictures = {};  ///< the same, without their averages
  std::vector<Cost> costs = {};
  /// Of the first so many of them, nothing but moments.
  std::map<std::uint64_t, std::shared_ptr<const Summary>> sums = {};

  std::size_t size() const { return costs.size(); }
  /// Those of [begin, end) that there are.
  Observations range(std::uint64_t begin, std::uint64_t end) const;
  /// All channels of one: where they are kept, or in `out`, which has room for them.
  std::span<const double> whole(std::size_t index, std::span<double> out) const;
  /// Takes those that follow.
  void append(KeptObservations&& next);
};

}  // namespace assay::harness
