#pragma once

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
  std::vector<std::vector<double>> values = {};       ///< as they were drawn; empty for pictures
  std::vector<std::unique_ptr<float[]>> texels = {};  ///< of pictures, one block each
  std::vector<std::span<const float>> pictures = {};  ///< the texels without averages
  std::vector<Cost> costs = {};
  /// Moments of the first observations, by their number.
  std::map<std::uint64_t, std::shared_ptr<const Summary>> sums = {};

  std::size_t size() const { return costs.size(); }
  /// The observations of [begin, end) that exist.
  Observations range(std::uint64_t begin, std::uint64_t end) const;
  /// All channels of one observation: a view, or `out`, which must have room for them.
  std::span<const double> whole(std::size_t index, std::span<double> out) const;
  /// Appends the observations that follow.
  void append(KeptObservations&& next);
};

}  // namespace assay::harness
