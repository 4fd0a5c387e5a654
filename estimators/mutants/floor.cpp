// Mutants of luminaire/floor: one property of the image is broken, in some pixels or in all.
//
// Each scales what some receivers get, as a wrong weight would; which receivers, and by how much,
// is the defect.

#include "luminaire/floor.h"

#include <functional>

#include "estimators/mutant.h"

namespace assay::plugins {

namespace {

using namespace luminaire;

struct Pixel {
  std::size_t x;
  std::size_t y;
};

/// The factor of a pixel of an image of this shape.
using Weight = std::function<double(const Pixel&, const ImageShape&)>;

/// A primary times a factor that is not 1 where it should be.
class WeightedPrimary {
 public:
  WeightedPrimary(AreaPrimary<> primary, double factor)
      : primary_(std::move(primary)), factor_(factor) {}

  LightSample draw(Stream& random) const { return primary_.draw(random); }
  double value(const LightSample& sample, Cost& cost) const {
    return factor_ * primary_.value(sample, cost);
  }

 private:
  AreaPrimary<> primary_;
  double factor_;
};

/// Four pixels, away from each other and from the edges.
double hot_pixels(const Pixel& p, const ImageShape& shape) {
  const bool row = p.y == shape.height / 4 || p.y == shape.height - 1 - shape.height / 4;
  const bool column = p.x == shape.width / 3 || p.x == shape.width - 1 - shape.width / 3;
  return row && column ? 1.3 : 1;
}

/// The tile of a quarter of the width and height to the right of and below the middle.
double tile(const Pixel& p, const ImageShape& shape) {
  const bool column = p.x >= shape.width / 2 && p.x < shape.width / 2 + shape.width / 4;
  const bool row = p.y >= shape.height / 2 && p.y < shape.height / 2 + shape.height / 4;
  return row && column ? 1.02 : 1;
}

double everywhere(const Pixel&, const ImageShape&) { return 1.004; }

double every_other_row(const Pixel& p, const ImageShape&) { return p.y % 2 == 0 ? 1.005 : 0.995; }

double last_column(const Pixel& p, const ImageShape& shape) {
  return p.x + 1 == shape.width ? 0.9 : 1;
}

std::vector<Channel> only_means(std::vector<Channel> channels) {
  for (Channel& channel : channels) channel = only_mean(channel);
  return channels;
}

std::shared_ptr<const Setup> weighted(Parameters& parameters, const Weight& weight) {
  const Floor floor = read_floor(parameters);
  std::vector<WeightedPrimary> primaries;
  for (std::size_t i = 0; i < floor.settings.size(); ++i) {
    const Pixel pixel{i % floor.shape.width, i / floor.shape.width};
    primaries.emplace_back(AreaPrimary<>(floor.settings[i]), weight(pixel, floor.shape));
  }
  return imaging<WeightedPrimary>(
      {floor.shape, only_means(floor_channels(floor)), std::move(primaries), floor.streams});
}

Entry entry(const char* name, const char* defect, Weight weight) {
  return mutant({name, "luminaire/floor", defect}, [weight = std::move(weight)](Parameters& given) {
    return weighted(given, weight);
  });
}

}  // namespace

std::vector<Entry> mutants_floor() {
  return {entry("floor_hot_pixels", "is 30 % too bright in four single pixels.", hot_pixels),
          entry("floor_tile",
                "is 2 % too bright in one tile, a quarter of the width and of the height.", tile),
          entry("floor_global", "is 0.4 % too bright in every pixel.", everywhere),
          entry("floor_interlaced",
                "is 0.5 % too bright in the even rows and 0.5 % too dark in the odd ones: the "
                "image's mean is right.",
                every_other_row),
          entry("floor_last_column",
                "is 10 % too dark in the last column, where a filter was cut off.", last_column)};
}

}  // namespace assay::plugins
