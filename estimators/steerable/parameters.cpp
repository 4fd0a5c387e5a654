#include "steerable/parameters.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

namespace assay::steerable {

namespace {

std::string text_of(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

}  // namespace

std::vector<ParameterInformation> parameters() {
  return {{.name = "level",
           .type = ParameterType::count,
           .summary = "how often the octahedron's triangles are cut into four",
           .fallback = "4",
           .low = 0,
           .high = 7},
          {.name = "coefficients",
           .type = ParameterType::string,
           .summary = "spherical harmonics of the lobe",
           .fallback = "9",
           .choices = {"1", "4", "9", "25"}},
          {.name = "offset",
           .summary = "added to the lobe's first coefficient, to make it positive",
           .fallback = "0.15",
           .low = 0,
           .high = 100},
          {.name = "floor",
           .summary = "added to the luminance at vertices, as a part of the sky's mean",
           .fallback = "0",
           .low = 0,
           .high = 1}};
}

Lobe read_any_lobe(Parameters& given) {
  return {.coefficients = std::stoul(given.string("coefficients")),
          .offset = given.number("offset")};
}

Lobe read_lobe(Parameters& given) {
  const Lobe lobe = read_any_lobe(given);
  const double least = lobe_minimum(lobe);
  if (least > 0) return lobe;
  const double needed = lobe.offset - least * std::sqrt(4 * std::numbers::pi);
  given.refuse("offset", "is " + text_of(lobe.offset) + ", so that the lobe falls to " +
                             text_of(least) + " and a density with it; it must be above " +
                             text_of(needed) + " for " + std::to_string(lobe.coefficients) +
                             " coefficients");
}

std::shared_ptr<const SkyTree> read_tree(Parameters& given, const sky::Setting& setting) {
  const auto tree = std::make_shared<const SkyTree>(
      setting.radiance(), Preparation{.level = given.count("level"),
                                      .coefficients = std::stoul(given.string("coefficients")),
                                      .floor = given.number("floor")});
  if (tree->least() > 0) return tree;
  given.refuse(
      "floor",
      "must be above 0 for this sky: it is black at a vertex of the subdivision, and light "
      "between black vertices would never be looked for");
}

}  // namespace assay::steerable
