#pragma once

// Pictures of another program as a set-up.

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "estimators/estimator.h"
#include "estimators/pictures.h"
#include "estimators/ready_made.h"

namespace assay::recorded {

/// Observation i is file i. Files are read one by one when they are asked for and not kept.
/// `data_file` tells which files they are (Setup::data_file()).
std::shared_ptr<const Setup> picture_setup(PictureStack stack, bool independent,
                                           std::string data_file);

/// Means with their errors; there is nothing to draw.
std::shared_ptr<const Setup> reference_setup(PictureMoments moments);

/// A channel of an observation: an element, or their average, which follows for claims that name
/// it.
Channel picture_channel(const ImageShape& shape, std::size_t place);

/// A picture's texels and their average.
void write_observation(std::span<const float> texels, std::span<double> out);

// Two pictures that are the same bit for bit are one, and no two observations.

/// A 64-bit digest of a picture's texels. Whole rows come one after the other, in any portions.
class PictureDigest {
 public:
  /// `row` is the number of texels in a row.
  explicit PictureDigest(std::size_t row) : row_(row) {}

  void add(std::span<const float> texels);

  std::uint64_t value() const { return value_; }
  bool finite() const { return finite_; }
  bool one_value() const { return one_value_; }

 private:
  std::size_t row_;
  std::uint64_t value_ = 0;
  std::optional<float> first_ = {};
  bool finite_ = true;
  bool one_value_ = true;
};

/// By their indices.
using TwoPictures = std::pair<std::uint64_t, std::uint64_t>;

class SeenPictures {
 public:
  /// Notes the picture of an observation by its digest. Returns two that had the same, or nullopt.
  /// Pictures of one value throughout, which noise may never have reached, count for nothing. So do
  /// pictures with texels that are not finite. As long as all are alike, such as a layer of depth,
  /// none counts. Thread-safe.
  std::optional<TwoPictures> note(std::uint64_t index, const PictureDigest& digest);

  /// Finds a picture here and the first one there that had the same digest, among those noted so
  /// far. Their indices are below `count`. nullopt where no two have it, or all of a side are
  /// alike.
  std::optional<TwoPictures> shared_with(const SeenPictures& other, std::uint64_t count) const;

 private:
  bool all_alike() const { return by_digest_.size() == 1 && repeated_; }

  mutable std::mutex mutex_;
  std::optional<TwoPictures> repeated_ = {};
  std::map<std::uint64_t, std::uint64_t> by_digest_;
};

}  // namespace assay::recorded
