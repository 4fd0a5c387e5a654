#pragma once

// Observations that another program made.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "estimators/estimator.h"

namespace assay::recorded {

/// Pictures of files, to be read rows after rows.
class PictureRows {
 public:
  virtual ~PictureRows() = default;
  /// Reads the whole rows of picture `index` that follow on those read of it so far, as many as
  /// there is room for. InputError as Pictures::read; once the last are read, also for a picture
  /// that is another one bit for bit. Thread-safe for different pictures.
  virtual void read(std::uint64_t index, std::span<float> texels) = 0;
};

/// Pictures of files as observations.
class Pictures {
 public:
  virtual ~Pictures() = default;
  /// Reads observation `index` as the file has it, with one of `texels` for each element. The
  /// estimator's `secondary` gives the same numbers, and their average after them. Thread-safe.
  virtual void read(std::uint64_t index, std::span<float> texels, Cost& cost) const = 0;
  /// The rows of all pictures, from their first row on.
  virtual std::unique_ptr<PictureRows> rows() const = 0;
  /// The files of a picture of each that are the same, bit for bit. It looks among the first
  /// `count` of each, as far as they have been read; nullopt if there are none. Pictures of one
  /// value throughout do not count: without noise all are alike. Any other two are one render given
  /// twice.
  virtual std::optional<std::pair<std::string, std::string>> shared_with(
      const Pictures& other, std::uint64_t count) const = 0;
};

/// True if a file name of the plugin `recorded` can be read only once: standard input, a pipe, a
/// device. Also true of a name below /dev or /proc that is gone already.
bool is_read_once(const std::string& file);

}  // namespace assay::recorded
