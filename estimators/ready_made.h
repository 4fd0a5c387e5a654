#pragma once

// What is asked of set-ups whose numbers another program made.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "estimators/estimator.h"

namespace assay::recorded {

/// Whether the means of a set-up's channels, with their errors, are all there is: nothing can be
/// drawn.
bool is_reference(const Setup& setup);

/// Of pictures as observations: the number of channels, of which nothing but the names is known.
/// nullopt for other set-ups. Millions of names need not be made where nobody asks for them.
std::optional<std::size_t> unknown_channels(const Setup& setup);

/// Of an estimator of such a set-up: observation `index` as the file has it, `texels` one for each
/// element. `secondary` gives the same numbers, and their average after them.
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

/// Those of a set-up of pictures, all from their first row on; null for other set-ups.
std::unique_ptr<PictureRows> picture_rows(const Setup& setup);

/// The average of texels that follows them in an observation.
double average_of(std::span<const float> texels);

/// Whether what a file name of the plugin `recorded` stands for is gone once it has been read:
/// standard input, a pipe, a device; also a name below /dev or /proc that is gone already.
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

/// Where an observation of a set-up stands: "b.exr" that holds it alone, "rows.txt:17"; "" where it
/// is in no file.
std::string observation_place(const Setup& setup, const WhichObservation& which);

/// The digest of a set-up whose observations stand in files; nullopt of others and where none is
/// known.
std::optional<std::uint64_t> observations_digest(const Setup& setup);

/// Whether observations are drawn into files that stay from one run to the next, so that drawing
/// one may cost nothing.
bool keeps_files(const Setup& setup);

/// The files of a picture of one set-up and of one of another that are the same, bit for bit, among
/// the first `count` of each as far as they have been read; nullopt where there are none. Pictures
/// of one value throughout count for nothing: without noise all are alike, and that is an outcome.
/// Any other two are one render given twice, even where a part of the picture is without noise.
std::optional<std::pair<std::string, std::string>> shared_picture(const Setup& first,
                                                                  const Setup& second,
                                                                  std::uint64_t count);

}  // namespace assay::recorded
