#pragma once

// Numbers that another program wrote as an OpenEXR picture.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace assay {

/// The rectangle of pixels that a channel has values for, its corner on the picture's canvas.
struct ExrWindow {
  std::int64_t left = 0;
  std::int64_t top = 0;
  std::size_t width = 0;
  std::size_t height = 0;

  friend bool operator==(const ExrWindow&, const ExrWindow&) = default;
};

/// One channel of a file. In a file of several parts its name begins with that of its part,
/// "albedo.R", unless it does so already.
struct ExrChannel {
  std::string name;
  ExrWindow window = {};
  int part = 0;
  std::string in_part = "";  ///< its name in the part
};

/// An OpenEXR file of one part or several, any pixel type and compression. It has scan lines or
/// tiles, of which the finest level is read. Reading takes one thread, the caller's.
///
/// InputError at the file if it is missing, is no OpenEXR file or is cut short. The same for a part
/// that is deep, or a picture of more than 2^27 pixels. Before anything is allocated, a picture is
/// refused that a file of this size cannot hold.
class ExrFile {
 public:
  explicit ExrFile(const std::string& file);
  ~ExrFile();
  ExrFile(const ExrFile&) = delete;
  ExrFile& operator=(const ExrFile&) = delete;

  const std::string& name() const;
  /// In the order of the file: part by part, by name.
  const std::vector<ExrChannel>& channels() const;
  /// The attribute `samplesPerPixel` that pbrt writes.
  std::optional<std::uint64_t> samples_per_pixel() const;

  /// Reads channels of one window, interleaved: as many rows from `first` on as there is room for.
  /// Rows come from the top. The texel of column x, row y and position c in `names` goes to
  /// texels[((y - first) * width + x) * names.size() + c]. Rows of chunks that are read in parts
  /// take longer. InputError, beside the above, for a name that is not there, windows that differ,
  /// and a sub-sampled channel.
  void read(std::span<const std::string> names, std::span<float> texels,
            std::size_t first = 0) const;
  /// The window that all of these share.
  ExrWindow window(std::span<const std::string> names) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// True if the file begins as OpenEXR files do.
bool is_exr(const std::string& file);

}  // namespace assay
