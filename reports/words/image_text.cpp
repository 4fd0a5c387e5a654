#include "reports/words/image_text.h"

#include <fmt/format.h>

#include "reports/words/number.h"

namespace assay::reports {
namespace {

std::string components_text(const Image& image) {
  std::string text;
  for (const std::string& component : image.components) {
    text += (text.empty() ? " of " : ", ") + component;
  }
  return text;
}

std::string constants_text(const Image& image) {
  std::string text;
  if (image.constant > 0) text += fmt::format("; constant elements: {}", image.constant);
  if (image.unseen > 0) {
    text += fmt::format(
        "; constant elements that are not at their reference: {}, rarer values may be unseen",
        image.unseen);
  }
  return text;
}

/// "24 images", or "24 and 32 images" where the sides have not as many.
std::string counted_images(const Test& test) {
  const std::vector<Sample>& sides = test.samples;
  if (sides.size() == 2 && sides[0].secondaries != sides[1].secondaries) {
    return fmt::format("{} and {} images", sides[0].secondaries, sides[1].secondaries);
  }
  return counted(test.image->replicates, "image", "images");
}

}  // namespace

std::string image_fact(const Test& test) {
  if (!test.image) return {};
  const Image& image = *test.image;
  std::string text = fmt::format("{} of {} x {} pixels{}", counted_images(test), image.width,
                                 image.height, components_text(image));
  if (!image.winner.place.empty()) {
    text += fmt::format("; differs most at {}, p = {} in all", image.winner.place,
                        p_text({}, image.winner.log10_p_adjusted));
  }
  return text + constants_text(image);
}

std::string map_title(const Map& map) {
  if (map.name == "z") return "signed z";
  if (map.name == "p_adjusted") return "p of each pixel, adjusted for all pixels";
  if (map.name == "reference") return "reference";
  if (map.name == "cells_observed") return "Draws in each cell";
  if (map.name == "cells_expected") return "Draws expected";
  if (map.name == "cells_z") return "Drawn - expected, in standard deviations";
  if (map.name == "cells_z_close")
    return "Where most is drawn, cell by cell, in standard deviations";
  const bool variance = map.name == "variance" || map.name == "other_variance";
  return fmt::format("{} of {}", variance ? "variance of one image" : "mean", map.source);
}

}  // namespace assay::reports
