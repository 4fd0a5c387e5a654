#pragma once

// Pictures that another program rendered: which files, which channels, what they are of.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "estimators/picture_file.h"

namespace assay::recorded {

/// True if a name is a pattern, or that of a picture by its ending or its contents.
bool names_pictures(const std::string& file);

/// The files that a pattern names, sorted by bytes; the one of that very name where there is one.
/// InputError at the pattern where there is none.
std::vector<std::string> files_of(const std::string& pattern);

/// Channels in the order in which they are observed: layer after layer, red, green, blue, alpha and
/// else by name.
struct PictureChannels {
  std::vector<std::string> names;       ///< Names in the file.
  std::vector<std::string> components;  ///< Without the layer that all of them share.
  /// True of a name that is a depth, `Z`, `ZBack` or `Depth`, infinite where nothing is hit. Its
  /// component is 0 there, and one behind it, `Z_infinite`, is 1 there and else 0.
  std::vector<bool> depth;
};

/// Chooses the channels that one of `patterns` (commas between) matches. The word "usual" stands
/// for R, G and B, or else Y. A file without them gives R, G and B of the one layer that has them,
/// or of Combined, or else its only channel. InputError at the file if there is none.
PictureChannels choose_channels(const PictureFile& file, const std::string& patterns);

/// "ViewLayer.Combined" of "ViewLayer.Combined.R"; "" of a name without a layer.
std::string layer_of(const std::string& channel);

/// Changes to pictures before they are compared. Both sides need the same.
struct PictureTreatment {
  Rounding rounding = Rounding::none;      ///< as the coarser side's files are rounded
  std::optional<PictureWindow> crop = {};  ///< on the canvas; all of the window when absent
  std::string mask = "";  ///< A picture. Where all its colours are 0 a pixel is left out.
  std::string finite =
      "";  ///< Patterns of files. Where a number of theirs is not finite it is too.
};

/// The part of pictures that is compared. Pixels that are left out are 0.
struct PictureView {
  PictureWindow whole = {};   ///< of each file
  PictureWindow window = {};  ///< inside it
  PictureChannels channels = {};
  Rounding of_files = Rounding::none;  ///< as the files are rounded
  Rounding rounding = Rounding::none;  ///< what is done to them
  /// True where a pixel of the window is left out; null if none is.
  std::shared_ptr<const std::vector<bool>> left_out = {};

  std::size_t row() const { return window.width * channels.components.size(); }
  ImageShape shape(bool independent = true) const;
  /// Reads as many rows from `first` on as there is room for. InputError at the file, also if it
  /// has another window.
  void read(const PictureFile& file, std::span<float> texels, std::size_t first = 0) const;
};

/// Pictures of one size and kind, one file each.
struct PictureStack {
  std::vector<std::string> files;
  PictureView view = {};

  /// One file, still of this size. InputError at the file.
  std::unique_ptr<const PictureFile> open(std::size_t index) const;
  /// Reads the texels of one file, shape().elements() of them. InputError at the file.
  void read(std::size_t index, std::span<float> texels) const;
};

/// Looks at the header of every file, and the first is the pattern for the rest. InputError at a
/// file that cannot be read, or has another size or lacks a channel.
PictureStack open_stack(std::vector<std::string> files, const std::string& patterns,
                        const PictureTreatment& treatment);

/// The channels of a picture that say how uncertain its means are. In `variance` and
/// `second_moment` the `*` stands for a channel's name: "Variance.*" is Variance.R for R, "m2_*" is
/// m2_path.R for path.R.
struct MomentChannels {
  std::string variance = "";       ///< Variance of one sample.
  std::string second_moment = "";  ///< E x^2 of one sample.
  /// Number of samples of the mean: a number, the name of a channel that counts them, or "" for
  /// pbrt's attribute samplesPerPixel.
  std::string samples = "";

  bool any() const { return !variance.empty() || !second_moment.empty(); }
};

/// The mean of every element, and its standard error; empty where it is exact.
struct PictureMoments {
  ImageShape shape = {};
  std::vector<double> mean = {};
  std::vector<double> standard_error = {};
};

/// The error channels that a picture is known to have by their names: those of pbrt's film and of
/// Mitsuba's moment integrator.
MomentChannels usual_moments(const PictureFile& file, const PictureChannels& channels);

/// One file as a mean with its error sqrt(variance / samples). With second moments the error is
/// sqrt((second moment - mean^2) / (samples - 1)). A difference below 0 is rounding and counts as
/// 0.
///
/// Below 1e5 samples the squared error is at least the average of the 3 x 3 pixels around. If all
/// of these are zero it is that of the image: a few dark samples may have missed a light.
///
/// InputError at the file for a channel that is not there, a texel that is not finite, and a
/// negative variance. Also for a count that is not given, below 1 or, with second moments, below 2.
PictureMoments read_moments(const std::string& file, const std::string& patterns,
                            const MomentChannels& errors, const PictureTreatment& treatment);

}  // namespace assay::recorded
