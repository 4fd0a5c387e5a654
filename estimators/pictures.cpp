#include "estimators/pictures.h"

#include <glob.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "estimators/core/mapped.h"
#include "estimators/core/value.h"

namespace assay::recorded {

namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError({.file = file}, why);
}

bool is_pattern(const std::string& text) { return text.find_first_of("*?[") != text.npos; }

std::string last_of(const std::string& channel) { return channel.substr(channel.rfind('.') + 1); }

std::size_t rank_of(const std::string& channel) {
  const std::vector<std::string> order{"R", "G", "B", "A"};
  return static_cast<std::size_t>(std::ranges::find(order, last_of(channel)) - order.begin());
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> pieces = pieces_of(text, ',');
  std::erase(pieces, "");
  return pieces;
}

/// The layers that have R, G and B, in the order of the file.
std::vector<std::string> coloured_layers(const std::vector<std::string>& names) {
  std::map<std::string, int> colours;
  std::vector<std::string> layers;
  for (const std::string& name : names) {
    // Statistics of a picture are none themselves.
    const bool statistic = name.starts_with("m2_") || name.find("Variance") != name.npos;
    if (!statistic && rank_of(name) < 3 && ++colours[layer_of(name)] == 3) {
      layers.push_back(layer_of(name));
    }
  }
  return layers;
}

std::vector<std::string> colours_of(const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  return {prefix + "R", prefix + "G", prefix + "B"};
}

std::vector<std::string> usual_channels(const PictureFile& file) {
  const std::vector<std::string> names = file.channel_names();
  if (file.has({"R", "G", "B"})) return colours_of("");
  if (file.has({"Y"})) return {"Y"};
  const std::vector<std::string> layers = coloured_layers(names);
  if (layers.size() == 1) return colours_of(layers[0]);
  for (const std::string& layer : layers) {
    if (last_of(layer) == "Combined") return colours_of(layer);
  }
  if (names.size() == 1) return names;
  file.refuse(
      "it is not clear which channels to use; choose them with `channels`, as in `channels: \"" +
      (names.empty() ? "R" : layer_of(names[0]) + ".*") + "\"`; it has " + quoted(names));
}

std::vector<std::string> matching_channels(const PictureFile& file, const std::string& patterns) {
  const std::vector<std::string> names = file.channel_names();
  std::set<std::string> chosen;
  for (const std::string& pattern : split_at_commas(patterns)) {
    bool any = false;
    for (const std::string& name : names) {
      if (!matches(pattern, name)) continue;
      any = true;
      chosen.insert(name);
    }
    if (any) continue;
    file.refuse("no channel matches `" + pattern + "`" +
                did_you_mean(pattern, names, "it has " + quoted(names)));
  }
  return {chosen.begin(), chosen.end()};
}

/// The third coordinate of a normal or a position has the others beside it.
bool is_depth(const std::string& name, const std::vector<std::string>& all) {
  const std::vector<std::string> depths{"Z", "ZBack", "Depth", "depth"};
  const std::string layer = layer_of(name);
  return std::ranges::find(depths, last_of(name)) != depths.end() &&
         std::ranges::find(all, layer.empty() ? "X" : layer + ".X") == all.end();
}

void name_components(PictureChannels& channels, const std::vector<std::string>& all) {
  const std::vector<std::string>& names = channels.names;
  const bool one_layer = std::ranges::all_of(
      names, [&](const std::string& name) { return layer_of(name) == layer_of(names[0]); });
  for (const std::string& name : names) {
    channels.components.push_back(one_layer ? last_of(name) : name);
    channels.depth.push_back(is_depth(name, all));
    if (channels.depth.back())
      channels.components.push_back(channels.components.back() + "_infinite");
  }
}

std::string size_text(const PictureWindow& window) {
  return std::to_string(window.width) + " x " + std::to_string(window.height);
}

std::vector<double> read_doubles(const PictureFile& file, const PictureView& view) {
  const ImageShape shape = view.shape();
  std::vector<float> texels(shape.elements());
  view.read(file, texels);
  const auto bad = std::ranges::find_if(texels, [](float x) { return !std::isfinite(x); });
  if (bad != texels.end()) {
    file.refuse("the channels " + quoted(view.channels.names) + " are not finite at " +
                element_place(shape, static_cast<std::size_t>(bad - texels.begin())));
  }
  return {texels.begin(), texels.end()};
}

/// The same pixels of other channels, as they are in the file.
PictureView view_of_others(const PictureView& view, const std::vector<std::string>& names) {
  PictureView others = view;
  others.channels = {.names = names, .components = names};
  others.channels.depth.assign(names.size(), false);
  others.rounding = Rounding::none;
  return others;
}

std::vector<std::string> substituted(const std::string& pattern,
                                     const std::vector<std::string>& by) {
  const std::size_t star = pattern.find('*');
  return mapped(by, [&](const std::string& name) {
    return star == pattern.npos ? pattern
                                : pattern.substr(0, star) + name + pattern.substr(star + 1);
  });
}

/// Samples of every pixel.
std::vector<double> read_counts(const PictureFile& file, const MomentChannels& errors,
                                const PictureView& view, double least) {
  const auto everywhere = [&](double count) {
    return std::vector<double>(view.shape().pixels(), count);
  };
  const std::string& text = errors.samples;
  if (text.empty()) {
    if (const auto count = file.samples_per_pixel()) return everywhere(static_cast<double>(*count));
    file.refuse(
        "it does not say how many samples its means average; give `samples`, a number or the "
        "name of the channel that counts them");
  }
  std::vector<double> counts;
  if (const auto number = parse_number(text)) {
    counts = everywhere(*number);
  } else {
    counts = read_doubles(file, view_of_others(view, {text}));
    for (std::size_t i = 0; view.left_out && i < counts.size(); ++i) {
      if ((*view.left_out)[i]) counts[i] = least;
    }
  }
  const auto few = std::ranges::find_if(counts, [&](double count) { return !(count >= least); });
  if (few == counts.end()) return counts;
  file.refuse("`samples` must be " + std::string(least > 1 ? "2" : "1") +
              " or more, and in some pixel is " + std::to_string(*few));
}

/// Copies rows of a file into those of a view.
void take_rows(const PictureView& view, std::span<const float> source, std::span<float> texels) {
  const std::size_t names = view.channels.names.size();
  const auto skipped = static_cast<std::size_t>(view.window.left - view.whole.left);
  float* out = texels.data();
  for (std::size_t y = 0; y < texels.size() / view.row(); ++y) {
    const float* in = source.data() + (y * view.whole.width + skipped) * names;
    for (std::size_t x = 0; x < view.window.width; ++x) {
      for (std::size_t c = 0; c < names; ++c, ++in) {
        const bool infinite =
            view.channels.depth[c] && *in == std::numeric_limits<float>::infinity();
        *out++ = infinite ? 0 : *in;
        if (view.channels.depth[c]) *out++ = infinite ? 1 : 0;
      }
    }
  }
}

void require_inside(const PictureFile& file, const PictureWindow& window,
                    const PictureWindow& whole) {
  const auto ends_inside = [](std::int64_t begin, std::size_t size, std::int64_t from,
                              std::size_t of) {
    return begin >= from &&
           begin + static_cast<std::int64_t>(size) <= from + static_cast<std::int64_t>(of);
  };
  file.require(ends_inside(window.left, window.width, whole.left, whole.width) &&
                   ends_inside(window.top, window.height, whole.top, whole.height),
               "its " + size_text(whole) + " pixels at x " + std::to_string(whole.left) + ", y " +
                   std::to_string(whole.top) + " do not cover the window of " + size_text(window) +
                   " at x " + std::to_string(window.left) + ", y " + std::to_string(window.top));
}

/// The pixels of a part in which one of the numbers is such.
std::vector<bool> pixels_with(const PictureFile& file, const PictureView& part,
                              bool (*is_such)(float)) {
  require_inside(file, part.window, part.whole);
  const ImageShape shape = part.shape();
  std::vector<float> texels(shape.elements());
  part.read(file, texels);
  std::vector<bool> found(shape.pixels());
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (is_such(texels[i])) found[i / shape.components.size()] = true;
  }
  return found;
}

/// Leaves out where all colours of the mask are 0. It has the size of the whole picture, of its
/// canvas, or of the crop.
void apply_mask(const std::string& name, const PictureFile& of, const PictureView& view,
                std::vector<bool>& left_out) {
  const std::unique_ptr<const PictureFile> file = open_picture(name);
  PictureView mask;
  mask.channels = choose_channels(*file, "usual");
  mask.whole = file->window(mask.channels.names);
  mask.window = view.window;
  if (mask.whole.width == view.window.width && mask.whole.height == view.window.height) {
    mask.window = mask.whole;
  } else if (mask.whole != view.whole && file->canvas() != of.canvas()) {
    file->refuse("it has " + size_text(mask.whole) + " pixels, and the pictures have " +
                 size_text(view.whole) + "; a mask must have as many");
  }
  const std::vector<bool> lit = pixels_with(*file, mask, [](float x) { return x != 0; });
  for (std::size_t i = 0; i < lit.size(); ++i) left_out[i] = left_out[i] || !lit[i];
}

/// Leaves out where a number of these files is not finite.
void apply_finite(const std::string& patterns, const std::string& chosen, const PictureView& view,
                  std::vector<bool>& left_out) {
  for (const std::string& pattern : split_at_commas(patterns)) {
    for (const std::string& name : files_of(pattern)) {
      const std::unique_ptr<const PictureFile> file = open_picture(name);
      PictureView all{.window = view.window, .channels = choose_channels(*file, chosen)};
      all.whole = file->window(all.channels.names);
      const auto bad = pixels_with(*file, all, [](float x) { return !std::isfinite(x); });
      for (std::size_t i = 0; i < bad.size(); ++i) left_out[i] = left_out[i] || bad[i];
    }
  }
}

/// The view of files like this one.
PictureView view_of(const PictureFile& file, const std::string& patterns,
                    const PictureTreatment& treatment) {
  PictureView view{.channels = choose_channels(file, patterns), .rounding = treatment.rounding};
  view.whole = file.window(view.channels.names);
  view.of_files = file.channel(view.channels.names[0]).rounding;
  view.window = treatment.crop.value_or(view.whole);
  require_inside(file, view.window, view.whole);
  std::vector<bool> left_out(view.window.width * view.window.height);
  if (!treatment.mask.empty()) apply_mask(treatment.mask, file, view, left_out);
  if (!treatment.finite.empty()) apply_finite(treatment.finite, patterns, view, left_out);
  const auto count = static_cast<std::size_t>(std::ranges::count(left_out, true));
  file.require(count < left_out.size(),
               "all its pixels are left out; check that the mask is not black");
  if (count > 0) view.left_out = std::make_shared<const std::vector<bool>>(std::move(left_out));
  return view;
}

/// Samples from which on a pixel's own variance is known well enough.
constexpr double many_samples = 1e5;

/// The mean of a component's values in the pixels around one and in itself.
double around(const std::vector<double>& values, const ImageShape& shape, std::size_t element) {
  const std::size_t components = shape.components.size();
  const std::size_t pixel = element / components;
  const std::size_t x = pixel % shape.width;
  const std::size_t y = pixel / shape.width;
  double sum = 0;
  double count = 0;
  for (std::size_t v = y > 0 ? y - 1 : 0; v < std::min<std::size_t>(y + 2, shape.height); ++v) {
    for (std::size_t u = x > 0 ? x - 1 : 0; u < std::min<std::size_t>(x + 2, shape.width); ++u) {
      sum += values[(v * shape.width + u) * components + element % components];
      ++count;
    }
  }
  return sum / count;
}

/// Raises variances of few samples, which are too small, and zero if the samples missed a light.
/// The pixels around give the variance; if they missed the light too, the image gives it.
void raise_where_few(const std::vector<double>& counts, const ImageShape& shape,
                     std::vector<double>& squared_errors) {
  const std::vector<double> own = squared_errors;
  const std::size_t components = shape.components.size();
  std::vector<double> anywhere(components);
  for (std::size_t i = 0; i < own.size(); ++i) anywhere[i % components] += own[i];
  for (double& mean : anywhere) mean /= static_cast<double>(own.size() / components);
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (counts[i / components] >= many_samples) continue;
    squared_errors[i] = std::max(own[i], around(own, shape, i));
    if (squared_errors[i] == 0) squared_errors[i] = anywhere[i % components];
  }
}

}  // namespace

bool names_pictures(const std::string& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status) && is_pattern(file)) return true;
  // A look into a pipe would take its bytes away.
  return file.ends_with(".exr") || (std::filesystem::is_regular_file(status) && is_picture(file));
}

/// "folder/*.pfm", by a picture of the folder; `otherwise` if it has none.
std::string pictures_of(const std::filesystem::path& folder, const std::string& otherwise) {
  std::set<std::string> patterns;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder / ".", ignored)) {
    const std::filesystem::path& path = entry.path();
    if (names_pictures(path)) patterns.insert(folder / ("*" + path.extension().string()));
  }
  return patterns.empty() ? otherwise : *patterns.begin();
}

std::vector<std::string> files_of(const std::string& pattern) {
  std::error_code ignored;
  if (std::filesystem::is_directory(pattern, ignored)) {
    refuse(pattern, "is a folder; name its pictures, as in `" +
                        pictures_of(pattern, pattern + "/*.exr") + "`");
  }
  if (std::filesystem::exists(pattern, ignored)) return {pattern};
  std::vector<std::string> files;
  glob_t found{};
  if (glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found) == 0) {
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  globfree(&found);
  if (files.empty()) {
    if (!is_pattern(pattern)) refuse(pattern, "there is no such file" + near_file(pattern));
    const std::string near = pictures_of(std::filesystem::path(pattern).parent_path(), "");
    refuse(pattern, "no file matches" + (near.empty() ? "" : "; did you mean `" + near + "`?"));
  }
  std::ranges::sort(files);
  return files;
}

PictureChannels choose_channels(const PictureFile& file, const std::string& patterns) {
  PictureChannels channels;
  if (patterns == "usual") {
    channels.names = usual_channels(file);
  } else {
    channels.names = matching_channels(file, patterns);
    // Layers as in the alphabet, the last names by rank.
    std::ranges::sort(channels.names, {}, [](const std::string& name) {
      return std::tuple(layer_of(name), rank_of(name), last_of(name));
    });
  }
  file.require(!channels.names.empty(), "no channel is chosen");
  name_components(channels, file.channel_names());
  return channels;
}

std::string layer_of(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == channel.npos ? "" : channel.substr(0, dot);
}

ImageShape PictureView::shape(bool independent) const {
  return {.width = window.width,
          .height = window.height,
          .components = channels.components,
          .independent = independent,
          .left = window.left,
          .top = window.top,
          .left_out = left_out};
}

void PictureView::read(const PictureFile& file, std::span<float> texels, std::size_t first) const {
  const std::size_t rows = texels.size() / row();
  const std::size_t above = static_cast<std::size_t>(window.top - whole.top);
  const bool plain = window.width == whole.width &&
                     std::ranges::none_of(channels.depth, [](bool depth) { return depth; });
  if (plain) {
    file.read(channels.names, texels, above + first);
  } else {
    std::vector<float> source(rows * whole.width * channels.names.size());
    file.read(channels.names, source, above + first);
    take_rows(*this, source, texels);
  }
  const std::size_t components = channels.components.size();
  if (rounding != Rounding::none) {
    const auto is_alpha = [](const std::string& name) { return last_of(name) == "A"; };
    const std::vector<bool> alpha = mapped(channels.components, is_alpha);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      texels[i] = rounded(texels[i], rounding, alpha[i % components]);
    }
  }
  if (!left_out) return;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if ((*left_out)[first * window.width + i / components]) texels[i] = 0;
  }
}

std::unique_ptr<const PictureFile> PictureStack::open(std::size_t index) const {
  auto file = open_picture(files[index]);
  const PictureWindow here = file->window(view.channels.names);
  if (here == view.whole) return file;
  file->require(here.width != view.whole.width || here.height != view.whole.height,
                "its data window lies elsewhere than that of `" + files[0] +
                    "`: render all files with one crop window");
  file->refuse("it has " + size_text(here) + " pixels, but `" + files[0] + "` has " +
               size_text(view.whole) + ": render all files at one size");
}

void PictureStack::read(std::size_t index, std::span<float> texels) const {
  view.read(*open(index), texels);
}

PictureStack open_stack(std::vector<std::string> files, const std::string& patterns,
                        const PictureTreatment& treatment) {
  const std::unique_ptr<const PictureFile> first = open_picture(files.at(0));
  PictureStack stack{.files = std::move(files), .view = view_of(*first, patterns, treatment)};
  for (std::size_t i = 1; i < stack.files.size(); ++i) stack.open(i);
  return stack;
}

MomentChannels usual_moments(const PictureFile& file, const PictureChannels& channels) {
  if (file.has(substituted("Variance.*", channels.names))) return {.variance = "Variance.*"};
  if (file.has(substituted("m2_*", channels.names))) return {.second_moment = "m2_*"};
  return {};
}

PictureMoments read_moments(const std::string& name, const std::string& patterns,
                            const MomentChannels& errors, const PictureTreatment& treatment) {
  const std::unique_ptr<const PictureFile> file = open_picture(name);
  const PictureView view = view_of(*file, patterns, treatment);
  PictureMoments moments{.shape = view.shape(), .mean = read_doubles(*file, view)};
  if (!errors.any()) return moments;
  file->require(view.channels.names.size() == view.channels.components.size(),
                "a depth that may be infinite has no variance; choose other channels");
  const ImageShape& shape = moments.shape;
  const bool by_variance = !errors.variance.empty();
  const std::vector<double> counts = read_counts(*file, errors, view, by_variance ? 1 : 2);
  moments.standard_error = read_doubles(
      *file, view_of_others(view, substituted(by_variance ? errors.variance : errors.second_moment,
                                              view.channels.names)));
  for (std::size_t i = 0; i < moments.mean.size(); ++i) {
    double& value = moments.standard_error[i];
    if (!by_variance) value = std::max(0.0, value - moments.mean[i] * moments.mean[i]);
    if (value < 0) file->refuse("the variance is negative at " + element_place(shape, i));
    const double count = counts[i / shape.components.size()];
    // A variance is taken about the mean of the same samples, and that of second moments is not yet
    // made up for it.
    value /= by_variance ? count : count - 1;
  }
  raise_where_few(counts, shape, moments.standard_error);
  for (double& value : moments.standard_error) value = std::sqrt(value);
  return moments;
}

}  // namespace assay::recorded
