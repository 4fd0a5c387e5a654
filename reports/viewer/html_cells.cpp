#include <fmt/format.h>

#include <algorithm>

#include "reports/viewer/html_parts.h"
#include "reports/words/image_text.h"

namespace assay::reports {
namespace {

const Map* map_named(const Test& test, const char* name) {
  for (const Map& map : test.maps) {
    if (map.name == name && !map.texels.values.empty()) return &map;
  }
  return nullptr;
}

}  // namespace

std::string cells_section(const Test& test) {
  const Map* observed = map_named(test, "cells_observed");
  const Map* expected = map_named(test, "cells_expected");
  const Map* difference = map_named(test, "cells_z");
  const Map* close = map_named(test, "cells_z_close");
  if (observed == nullptr || expected == nullptr || difference == nullptr) return {};
  // One scale, so that equal colours are equal counts.
  ColourScale counts = scale_of(*observed);
  counts.high = std::max(counts.high, scale_of(*expected).high);
  const auto with_axes = [](const Map& map, const char* more) {
    return fmt::format("{}: {}{}.", map_title(map), map.source, more);
  };
  constexpr const char* red_and_blue = "; red where too many were drawn, blue where too few";
  return "<div class=\"figures\">\n" +
         figure(map_picture(*observed, 0, counts, nullptr), with_axes(*observed, "")) +
         figure(map_picture(*expected, 0, counts, nullptr), with_axes(*expected, "")) +
         figure(map_picture(*difference, 0, scale_of(*difference), nullptr),
                with_axes(*difference, red_and_blue)) +
         (close == nullptr ? ""
                           : figure(map_picture(*close, 0, scale_of(*close), nullptr),
                                    with_axes(*close, red_and_blue))) +
         "</div>\n";
}

}  // namespace assay::reports
