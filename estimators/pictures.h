#pragma once

// Pictures that another program rendered: which files, which channels, what they are of.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "estimators/exr_file.h"
#include "estimators/image.h"

namespace assay::recorded {

/// Whether a file's name is a pattern, or that of an OpenEXR picture by its ending or its contents.
bool names_pictures(const std::string& file);

/// The files that a pattern names, sorted by bytes; the one of that very name where there is one.
/// InputError at the pattern where there is none.
std::vector<std::string> files_of(const std::string& pattern);

/// Channels in the order in which they are observed: layer after layer, red, green, blue, alpha and
/// else by name.
struct PictureChannels {
  std::vector<std::string> names;       ///< as in the file
  std::vector<std::string> components;  ///< without the layer that all of them share
};

/// The channels that one of the patterns in `patterns` (commas between) matches. With "usual" those
/// that a renderer shows: R, G and B; else Y; else R, G and B of the one layer that has them, or of
/// the one called Combined; else the only channel. InputError at the file where there is none.
PictureChannels choose_channels(const ExrFile& file, const std::string& patterns);

/// Pictures of one size and kind, one file each.
struct PictureStack {
  std::vector<std::string> files;
  ExrWindow window = {};
  PictureChannels channels = {};

  ImageShape shape(bool independent) const;
  /// One file, still of this size. InputError at the file.
  std::unique_ptr<const ExrFile> open(std::size_t index) const;
  /// Reads the texels of one file, shape().elements() of them. InputError at the file.
  void read(std::size_t index, std::span<float> texels) const;
};

/// Looks at the header of every file, and the first is the pattern for the rest. InputError at a
/// file that cannot be read, or has another size or lacks a channel.
PictureStack open_stack(std::vector<std::string> files, const std::string& patterns);

/// Where a picture says how uncertain its means are. In `variance` and `second_moment` the `*`
/// stands for a channel's name: "Variance.*" is Variance.R for R, "m2_*" is m2_path.R for path.R.
struct MomentChannels {
  std::string variance = "";       ///< of one sample
  std::string second_moment = "";  ///< E x^2 of one sample
  /// Samples that the mean is of: a number, the name of a channel that counts them, or "" for the
  /// attribute samplesPerPixel of pbrt.
  std::string samples = "";

  bool any() const { return !variance.empty() || !second_moment.empty(); }
};

/// The mean of every element, and its standard error; empty where it is exact.
struct PictureMoments {
  ExrWindow window = {};
  PictureChannels channels = {};
  std::vector<double> mean = {};
  std::vector<double> standard_error = {};

  ImageShape shape() const;
};

/// What a picture is known to say of its errors by the names of its channels: of pbrt's film and
/// of Mitsuba's moment integrator.
MomentChannels usual_moments(const ExrFile& file, const PictureChannels& channels);

/// One file as a mean with its error sqrt(variance / samples), of second moments
/// sqrt((second moment - mean^2) / (samples - 1)), where a difference below 0 is rounding and taken
/// as 0. Where there are fewer than 1e5 samples the squared error is that of the 3 x 3 pixels
/// around, on average, if that is larger, and where all of these are zero that of the image: a few
/// dark samples show a variance that is too small, and one of zero where they missed a light.
/// InputError at the file for a channel that is not there, a texel that is not finite, a negative
/// variance, and a count that is not given, below 1 or, of second moments, below 2.
PictureMoments read_moments(const std::string& file, const std::string& patterns,
                            const MomentChannels& errors);

}  // namespace assay::recorded
