#pragma once

// Questions to set-ups whose numbers another program made.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "estimators/estimator.h"

namespace assay::recorded {

/// True if a set-up has only the means of its channels, with their errors: nothing can be drawn.
bool is_reference(const Setup& setup);

/// The number of channels of pictures as observations, of which only the names are known. nullopt
/// for other set-ups. It saves making millions of names.
std::optional<std::size_t> unknown_channels(const Setup& setup);

/// Reads observation `index` of such a set-up as the file has it, with one of `texels` for each
/// element. The estimator's `secondary` gives the same numbers, and their average after them.
void read_picture(Estimator& pictures, std::uint64_t index, std::span<float> texels, Cost& cost);

/// Pictures of files, to be read rows after rows.
class PictureRows {
 public:
  virtual ~PictureRows() = default;
  /// Reads the whole rows of picture `index` that follow on those read of it so far, as many as
  /// there is room for. InputError as read_picture; once the last are read, also for a picture that
  /// is another one bit for bit. Thread-safe for different pictures.
  virtual void read(std::uint64_t index, std::span<float> texels) = 0;
};

/// The rows of a set-up of pictures, all from their first row on; null for other set-ups.
std::unique_ptr<PictureRows> picture_rows(const Setup& setup);

/// True if a file name of the plugin `recorded` can be read only once: standard input, a pipe, a
/// device. Also true of a name below /dev or /proc that is gone already.
bool is_read_once(const std::string& file);

/// Which observation, of a set-up that may be drawn by streams.
struct WhichObservation {
  std::uint64_t index = 0;
  StreamKey key = {};
  std::uint64_t primaries = 1;
};

/// A set-up whose observations stand in files.
class InFiles {
 public:
  virtual ~InFiles() = default;
  virtual std::string place_of(const WhichObservation& which) const = 0;
  /// Tells what was read from what was read elsewhere, where that is known.
  virtual std::optional<std::uint64_t> digest() const { return {}; }
};

/// The place of an observation of a set-up: "b.exr" that holds it alone, "rows.txt:17". "" if it is
/// in no file.
std::string observation_place(const Setup& setup, const WhichObservation& which);

/// The digest of a set-up whose observations stand in files; nullopt of others and where none is
/// known.
std::optional<std::uint64_t> observations_digest(const Setup& setup);

/// True if observations are drawn into files that stay from one run to the next. Drawing one may
/// then cost nothing.
bool keeps_files(const Setup& setup);

/// The files of a picture of each set-up that are the same, bit for bit. It looks among the first
/// `count` of each, as far as they have been read; nullopt if there are none. Pictures of one value
/// throughout do not count: without noise all are alike. Any other two are one render given twice.
std::optional<std::pair<std::string, std::string>> shared_picture(const Setup& first,
                                                                  const Setup& second,
                                                                  std::uint64_t count);

}  // namespace assay::recorded
