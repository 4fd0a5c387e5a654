#pragma once

// The common case of an image: every element the mean of independent primaries of its own.

#include <memory>
#include <utility>
#include <vector>

#include "estimators/estimator.h"

namespace assay {

/// The source of the random numbers of an image's elements.
enum class ImageStreams {
  own,    ///< a substream for each element: the elements are independent
  shared  ///< one for all of them: each element's primary gets the same numbers
};

/// A secondary estimate is an image at `primaries` samples an element. `Primary` is as for
/// AveragingEstimator; there is one for each element.
template <class Primary>
class ImagingEstimator final : public Estimator {
 public:
  ImagingEstimator(const std::vector<Primary>& primaries, ImageStreams streams)
      : streams_(streams) {
    for (const Primary& primary : primaries) elements_.emplace_back(primary);
  }

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const std::size_t substream = streams_ == ImageStreams::own ? i : 0;
      Stream mine = random.substream(static_cast<std::uint32_t>(substream));
      elements_[i].secondary(mine, primaries, out.subspan(i, 1), cost);
    }
  }

 private:
  std::vector<AveragingEstimator<Primary>> elements_;
  ImageStreams streams_;
};

/// The parts of an image: a channel and a primary for each element, in the shape's order. The
/// channels' names are those of element_name().
template <class Primary>
struct ImageParts {
  ImageShape shape;
  std::vector<Channel> channels;
  std::vector<Primary> primaries;
  ImageStreams streams = ImageStreams::own;
};

/// The set-up of an image whose elements are averages. `parts.channels` and `parts.primaries` have
/// parts.shape.elements() entries.
template <class Primary>
std::shared_ptr<const Setup> imaging(ImageParts<Primary> parts) {
  parts.shape.independent = parts.streams == ImageStreams::own;
  for (std::size_t i = 0; i < parts.channels.size(); ++i) {
    parts.channels[i].name = element_name(parts.shape, i);
  }
  const auto make = [primaries = std::move(parts.primaries), streams = parts.streams] {
    return std::make_unique<ImagingEstimator<Primary>>(primaries, streams);
  };
  return setup_of(
      {.channels = std::move(parts.channels), .make = make, .image = std::move(parts.shape)});
}

}  // namespace assay
