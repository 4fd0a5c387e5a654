#pragma once

// Numbers that another program wrote as a picture: OpenEXR, PFM or PNG.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace assay {

/// The rectangle of pixels that a channel has values for, its corner on the picture's canvas.
struct PictureWindow {
  std::int64_t left = 0;
  std::int64_t top = 0;
  std::size_t width = 0;
  std::size_t height = 0;

  friend bool operator==(const PictureWindow&, const PictureWindow&) = default;
};

/// How a file rounded its numbers, from the finest. PNG clips to [0, 1] and rounds what sRGB's
/// curve makes of a colour; it rounds alpha itself.
enum class Rounding { none, half, png16, png8 };

/// The number that a file of this rounding would hold. Half precision leaves what exceeds its
/// range.
float rounded(float value, Rounding how, bool alpha);

/// One channel of a file. In a file of several parts its name begins with that of its part,
/// "albedo.R", unless it does so already.
struct FileChannel {
  std::string name;
  PictureWindow window = {};
  Rounding rounding = Rounding::none;
  int part = 0;
  std::string in_part = "";  ///< its name in the part
};

/// A picture of R, G and B, or Y, or any channels; A is alpha. Reading takes one thread, the
/// caller's.
class PictureFile {
 public:
  virtual ~PictureFile() = default;
  PictureFile(const PictureFile&) = delete;
  PictureFile& operator=(const PictureFile&) = delete;

  const std::string& name() const { return name_; }
  /// InputError at the file.
  [[noreturn]] void refuse(const std::string& why) const;
  /// The same unless something holds.
  void require(bool holds, const std::string& why) const;
  /// In the order of the file: part by part, by name.
  const std::vector<FileChannel>& channels() const { return channels_; }
  std::vector<std::string> channel_names() const;
  /// True if there is a channel of each of these names.
  bool has(const std::vector<std::string>& names) const;
  /// The whole picture, of which a crop has windows.
  const PictureWindow& canvas() const { return canvas_; }
  /// The attribute `samplesPerPixel` that pbrt writes.
  std::optional<std::uint64_t> samples_per_pixel() const { return samples_; }

  /// InputError, beside that of read_rows, for a name that is not there.
  const FileChannel& channel(const std::string& name) const;
  /// The window that all of these share. InputError for windows that differ.
  PictureWindow window(std::span<const std::string> names) const;
  /// Reads channels of one window, interleaved: as many rows from `first` on as there is room for.
  /// Rows come from the top. The texel of column x, row y and position c in `names` goes to
  /// texels[((y - first) * width + x) * names.size() + c]. Rows of chunks that are read in parts
  /// take longer. InputError for a file that is damaged, and a sub-sampled channel.
  void read(std::span<const std::string> names, std::span<float> texels,
            std::size_t first = 0) const;

 protected:
  explicit PictureFile(std::string name) : name_(std::move(name)) {}

  virtual void read_rows(std::span<const std::string> names, std::span<float> texels,
                         std::size_t first, std::size_t last) const = 0;

  std::string name_;
  std::vector<FileChannel> channels_ = {};
  PictureWindow canvas_ = {};
  std::optional<std::uint64_t> samples_ = {};
};

/// Opens a file, whose first bytes tell its kind:
/// * OpenEXR of one part or several, any pixel type and compression. It has scan lines or tiles, of
///   which the finest level is read.
/// * PFM, by the ending `.pfm` too. The scale's sign is the order of bytes, and its size is left
///   aside.
/// * PNG of 8 bits or fewer, or 16, a palette or grey. Colours are taken from sRGB's curve to
///   linear light, in [0, 1].
///
/// InputError at the file if it is missing, is none of these or is cut short. The same for a part
/// that is deep, a PNG of another gamma than sRGB's, or a picture of more than 2^27 pixels. Before
/// anything is allocated, a picture is refused that a file of this size cannot hold.
std::unique_ptr<const PictureFile> open_picture(const std::string& file);

/// True if the file begins as one of these do.
bool is_picture(const std::string& file);

}  // namespace assay
