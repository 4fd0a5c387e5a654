#pragma once

// The interface of a plugin: static information, an immutable set-up, and estimators made from it.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "estimators/cost.h"
#include "estimators/parameters.h"
#include "estimators/sampler.h"
#include "estimators/stream.h"

namespace assay {

/// The shape of an image, the first elements() channels of a set-up. The channel of column x, row y
/// and component c has the index (y * width + x) * components + c.
struct ImageShape {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::string> components = {"value"};
  /// True if the pixels of one observation are independent. They are not if they share random
  /// numbers, if a filter reaches over several, or if a chain visits them.
  bool independent = true;
  /// Corner in the whole picture, of which a crop shows a part.
  std::int64_t left = 0;
  std::int64_t top = 0;
  /// True where a pixel is left out; it counts as 0. Null if none is.
  std::shared_ptr<const std::vector<bool>> left_out = {};

  std::size_t pixels() const { return width * height; }
  std::size_t elements() const { return pixels() * components.size(); }
};

/// The channel's name of one pixel, as claims call it: "x3y5", with several components
/// "x3y5.red". Columns and rows are those of the whole picture.
std::string element_name(const ImageShape& shape, std::size_t element);
/// The same as messages call it: "pixel x 3, y 5 of red".
std::string element_place(const ImageShape& shape, std::size_t element);

/// Observations [first, last) of one stream, about to be asked for in order.
struct Announcement {
  StreamKey key;
  std::uint64_t first = 0;
  std::uint64_t last = 0;

  /// The end of those from this one on; the observation alone if it is not announced.
  std::uint64_t end_from(StreamKey stream, std::uint64_t observation) const {
    const bool ahead = stream == key && observation >= first && observation < last;
    return ahead ? last : observation + 1;
  }
};

/// Yields secondary estimates. One object per worker; nothing leaks from one call to the next, so
/// that an observation is a function of its stream alone.
class Estimator {
 public:
  virtual ~Estimator() = default;
  /// Tells which observations come next, for an estimator that fetches several at a time. It
  /// changes no number. Observations may be asked for without it.
  virtual void announce(const Announcement&) {}
  /// CPU seconds spent so far outside of the calling thread: those of another process.
  virtual double seconds_elsewhere() const { return 0; }
  /// Writes one secondary estimate built from `primaries` >= 1 primary estimates, one number per
  /// channel, and adds what it cost.
  virtual void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                         Cost& cost) = 0;
};

/// How the expectation of a secondary estimate relates to the integral.
enum class BiasClass {
  unbiased,
  inverse_primaries,  ///< Bias falls like 1 / primaries, as of ratios.
  inverse_bootstrap,  ///< Bias falls like 1 / bootstrap, the points of a normaliser.
  start_up,           ///< Bias of a chain that has not forgotten its start.
  reconstruction,     ///< Bias of a filter or an interpolation.
};

/// How secondary estimates relate to primaries and to the integral.
struct Nature {
  bool averages = true;
  std::optional<BiasClass> bias = {};  ///< unknown where the program does not say
};

/// One number of an observation, and what is known of it exactly.
struct Channel {
  std::string name = "value";
  std::optional<double> mean = {};      ///< Analytic mean of a secondary estimate.
  double mean_error = 0;                ///< Standard error or error bound of `mean`.
  std::optional<double> variance = {};  ///< Variance of ONE primary estimate.
  double low = -std::numeric_limits<double>::infinity();  ///< No value is below.
  double high = std::numeric_limits<double>::infinity();  ///< No value is above.
  double rounding = 0;      ///< Values that differ by no more are the same number.
  bool diagnostic = false;  ///< Tested only where a claim names it.
};

/// A sampler under the name by which claims reach it.
struct NamedSampler {
  std::string name;
  std::shared_ptr<const Sampler> sampler;
};

/// Which observation, of a set-up that may be drawn by streams.
struct WhichObservation {
  std::uint64_t index = 0;
  StreamKey key = {};
  std::uint64_t primaries = 1;
};

namespace recorded {
class Pictures;  // ready_made.h
}

/// Everything that all workers share: scene, tables, references. Draws nothing at random.
class Setup {
 public:
  virtual ~Setup() = default;
  virtual std::size_t channel_count() const = 0;
  /// `place` is below channel_count().
  virtual Channel channel(std::size_t place) const = 0;
  /// All of them. An image has millions.
  std::vector<Channel> channels() const;
  virtual std::unique_ptr<Estimator> make() const = 0;
  virtual std::vector<NamedSampler> samplers() const { return {}; }
  /// The shape of an observation whose first channels are an image. They are rounded to single
  /// precision.
  virtual std::optional<ImageShape> image() const { return {}; }
  /// The most secondary estimates there are (recorded data), if bounded.
  virtual std::optional<std::uint64_t> observations() const { return {}; }
  /// The file that ready-made observations are read from: two set-ups of one file share its rows.
  virtual std::string data_file() const { return {}; }
  /// The stream that ready-made observations were drawn from, where they say so.
  virtual std::optional<StreamKey> data_stream() const { return {}; }
  /// Tells ready-made observations from those read elsewhere, where that is known.
  virtual std::optional<std::uint64_t> data_digest() const { return {}; }
  /// The place of an observation: "b.exr" that holds it alone, "rows.txt:17". "" if it is in no
  /// file.
  virtual std::string place_of(const WhichObservation&) const { return {}; }
  /// True if observations are drawn into files that stay from one run to the next. Drawing one may
  /// then cost nothing.
  virtual bool keeps_files() const { return false; }
  /// Pictures of files as observations; null of other set-ups.
  virtual const recorded::Pictures* pictures() const { return nullptr; }
  /// True if there are only the means of the channels, with their errors: nothing can be drawn.
  virtual bool is_reference() const { return false; }
  /// Replaces the catalogue's `averages` and `bias` if another program must be asked for them.
  virtual std::optional<Nature> nature() const { return {}; }
  virtual Cost cost() const { return {}; }
};

/// The parts of a set-up that states what they say. `make` gives a worker its estimator.
struct SetupParts {
  std::vector<Channel> channels = {};  ///< an image's follow its elements
  std::function<std::unique_ptr<Estimator>()> make;
  std::vector<NamedSampler> samplers = {};
  std::optional<ImageShape> image = {};
  /// The image's elements, of which nothing is known by default. They repeat where they are fewer,
  /// and take the names of element_name().
  std::vector<Channel> elements = {Channel{}};
  std::optional<Nature> nature = {};
  Cost cost = {};
};
std::shared_ptr<const Setup> setup_of(SetupParts parts);

/// An estimator that is a function of what secondary() is given.
template <class Function>
class FunctionEstimator final : public Estimator {
 public:
  explicit FunctionEstimator(Function function) : function_(std::move(function)) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    function_(random, primaries, out, cost);
  }

 private:
  Function function_;
};

/// Makes such estimators, for SetupParts::make. Every worker gets a copy of the function: what a
/// `mutable` one captures by value is scratch.
template <class Function>
std::function<std::unique_ptr<Estimator>()> estimating(Function function) {
  return [function = std::move(function)] {
    return std::make_unique<FunctionEstimator<Function>>(function);
  };
}

/// Static facts of a plugin, known without preparing it; `assay describe` prints them.
struct Information {
  std::string name;         ///< "luminaire/area"
  std::string summary;      ///< one line
  std::string description;  ///< the manual: statement, formula, source
  std::vector<ParameterInformation> parameters = {};
  BiasClass bias = BiasClass::unbiased;
  /// True if a secondary estimate is the mean of `primaries` independent primaries. Its variance
  /// then falls like 1 / primaries, and `primaries` may be chosen from the pilot.
  bool averages = true;
  /// `bias` and `averages` are another program's to say: Setup::nature() has them.
  bool says_nature = false;
  std::string original = "";  ///< of a mutant: the plugin whose streams it uses
  std::string defect = "";    ///< of a mutant: what is wrong
};

struct Entry {
  Information information;
  std::function<std::shared_ptr<const Setup>(Parameters&)> prepare;
};

/// A primary in two halves: draw(stream) makes its random choices, value(choices, cost) works out
/// what they give and draws nothing.
template <class Primary>
concept TwoStepPrimary = requires(const Primary& primary, Stream& random, Cost& cost) {
  { primary.value(primary.draw(random), cost) } -> std::convertible_to<double>;
};

/// A secondary estimate that is the mean of independent primaries. `Primary` is callable as
/// double(Stream&) or double(Stream&, Cost&), or is a TwoStepPrimary. It is a template so that a
/// primary of a few nanoseconds is inlined into the loop.
template <class Primary>
struct Averaging {
  Primary primary = {};

  void operator()(Stream& random, std::uint64_t primaries, std::span<double> out, Cost& cost) {
    double sum = 0;
    for (std::uint64_t i = 0; i < primaries; ++i) {
      if constexpr (std::is_invocable_v<Primary&, Stream&, Cost&>) {
        sum += primary(random, cost);
      } else {
        sum += primary(random);
      }
    }
    out[0] = sum / static_cast<double>(primaries);
    cost.samples += primaries;
  }
};

/// The same for a two-step primary: it makes a batch of choices before it follows them up. So the
/// processor overlaps the arithmetic of many choices, instead of waiting for each ray. The order of
/// random numbers and of the sum does not depend on the batch.
template <TwoStepPrimary Primary>
struct Averaging<Primary> {
  using Choices = decltype(std::declval<const Primary&>().draw(std::declval<Stream&>()));

  Primary primary = {};
  std::array<Choices, 32> choices = {};  ///< scratch

  void operator()(Stream& random, std::uint64_t primaries, std::span<double> out, Cost& cost) {
    double sum = 0;
    for (std::uint64_t done = 0; done < primaries; done += choices.size()) {
      const std::uint64_t count = std::min<std::uint64_t>(choices.size(), primaries - done);
      for (std::uint64_t i = 0; i < count; ++i) choices[i] = primary.draw(random);
      for (std::uint64_t i = 0; i < count; ++i) sum += primary.value(choices[i], cost);
    }
    out[0] = sum / static_cast<double>(primaries);
    cost.samples += primaries;
  }
};

/// The set-up of an averaging estimator with one channel. Every worker gets a copy of the primary:
/// hold shared state by shared_ptr<const T>. `samplers` are the sources of points inside.
template <class Primary>
std::shared_ptr<const Setup> averaging(Channel channel, Primary primary,
                                       std::vector<NamedSampler> samplers = {}) {
  return setup_of({.channels = {std::move(channel)},
                   .make = estimating(Averaging<Primary>{std::move(primary)}),
                   .samplers = std::move(samplers)});
}

/// The parts of an image: what is known of its elements, in the shape's order, and their primaries.
/// Both repeat where they are fewer: those of one row serve rows that are alike. Elements that are
/// independent have a substream each. Else the primaries of all elements get the same numbers.
template <class Primary>
struct ImageParts {
  ImageShape shape;
  std::vector<Channel> elements;
  std::vector<Primary> primaries;
};

/// The set-up of an image whose elements are averages. A secondary estimate is an image at
/// `primaries` samples an element. `Primary` is as for Averaging. There is one primary at least.
template <class Primary>
std::shared_ptr<const Setup> imaging(ImageParts<Primary> parts) {
  const auto make = [primaries = std::move(parts.primaries), own = parts.shape.independent] {
    std::vector<Averaging<Primary>> averages;
    for (const Primary& primary : primaries) averages.push_back({primary});
    auto image = [averages = std::move(averages), own](Stream& random, std::uint64_t count,
                                                       std::span<double> out, Cost& cost) mutable {
      for (std::size_t i = 0; i < out.size(); ++i) {
        Stream mine = random.substream(static_cast<std::uint32_t>(own ? i : 0));
        averages[i % averages.size()](mine, count, out.subspan(i, 1), cost);
      }
    };
    return std::make_unique<FunctionEstimator<decltype(image)>>(std::move(image));
  };
  return setup_of(
      {.make = make, .image = std::move(parts.shape), .elements = std::move(parts.elements)});
}

}  // namespace assay

// Written out in one place, as every plugin's file makes, copies and destroys some.
extern template class std::vector<assay::ParameterInformation>;
extern template class std::vector<assay::Channel>;
extern template class std::vector<assay::NamedSampler>;
