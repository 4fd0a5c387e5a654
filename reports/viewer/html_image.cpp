#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/formats/base64.h"
#include "reports/viewer/colour_scale.h"
#include "reports/viewer/html_parts.h"
#include "reports/viewer/svg.h"
#include "reports/words/image_text.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr double picture_side = 288;  // of the longer side of a preview
constexpr double margin = 6;
constexpr double bar_height = 12;
constexpr std::size_t bar_steps = 128;

std::string data_uri(const Pixels& pixels) {
  return "data:image/png;base64," + base64(png(pixels));
}

Size shown_size(const Map& map) {
  const double longest = static_cast<double>(std::max(map.width, map.height));
  // Whole factors where pixels are magnified, so that all look the same size.
  const double fits = picture_side / longest;
  const double factor = fits >= 1 ? std::floor(fits) : fits;
  return {static_cast<double>(map.width) * factor, static_cast<double>(map.height) * factor};
}

/// The scale as a picture of one row.
Pixels bar_of(const ColourScale& scale) {
  Pixels bar{bar_steps, 1, {}};
  for (std::size_t i = 0; i < bar_steps; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(bar_steps - 1);
    const double value = scale.palette == Palette::evidence
                             ? scale.low * std::pow(scale.high / scale.low, share)
                             : scale.low + share * (scale.high - scale.low);
    bar.rows.push_back(scale(value));
  }
  return bar;
}

/// True if numbers lie beyond the ends of the scale.
bool is_cut(const Map& map, const ColourScale& scale) {
  return std::any_of(map.texels.values.begin(), map.texels.values.end(), [&](float value) {
    return static_cast<double>(value) < scale.low || static_cast<double>(value) > scale.high;
  });
}

struct Legend {
  std::string low, middle, high;
};

Legend legend_of(const Map& map, const ColourScale& scale) {
  const bool cut = is_cut(map, scale);
  if (scale.palette == Palette::difference) {
    return {(cut ? "<= " : "") + human(scale.low), "0", (cut ? ">= +" : "+") + human(scale.high)};
  }
  if (scale.palette == Palette::evidence) return {cut ? "<= 1e-6" : "1e-6", "0.001", "1"};
  return {human(scale.low, 3), human((scale.low + scale.high) / 2, 3), human(scale.high, 3)};
}

struct Shown {
  const Map& map;
  std::size_t component;
  const ImageFinding* found;  ///< to outline, or null
};

std::string preview(const Shown& shown, const ColourScale& scale) {
  const Size size = shown_size(shown.map);
  const double width = std::max(size.width, 180.0);
  const double bar = margin + size.height + 8;
  Svg svg({width + 2 * margin, bar + bar_height + line_height + 4}, map_title(shown.map));
  const Box place{margin, margin, size.width, size.height};
  svg.image(place, data_uri(picture_of(shown.map, shown.component, scale)));
  svg.box(place, "cell");
  if (shown.found != nullptr) {
    const double factor = size.width / static_cast<double>(shown.map.width);
    const Box cell{margin + factor * static_cast<double>(shown.found->x),
                   margin + factor * static_cast<double>(shown.found->y),
                   factor * static_cast<double>(shown.found->width),
                   factor * static_cast<double>(shown.found->height)};
    svg.box(cell, "outline");
    svg.box(cell, "found", shown.found->place);
  }
  svg.image({margin, bar, width, bar_height}, data_uri(bar_of(scale)));
  svg.box({margin, bar, width, bar_height}, "cell");
  const Legend legend = legend_of(shown.map, scale);
  const double text = bar + bar_height + line_height - 3;
  svg.text({.at = {margin, text}, .content = legend.low});
  svg.text({.at = {margin + width / 2, text}, .content = legend.middle, .anchor = Anchor::middle});
  svg.text({.at = {margin + width, text}, .content = legend.high, .anchor = Anchor::end});
  return svg.finish();
}

std::string caption(const Shown& shown) {
  std::string text = map_title(shown.map);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (shown.map.components.size() > 1) text += ", " + shown.map.components[shown.component];
  if (shown.map.name == "z") {
    text += ": red where the first image is brighter, blue where it is darker";
    if (shown.found != nullptr) text += "; outlined: " + shown.found->place;
  }
  if (shown.map.name == "p_adjusted") text += ", on a logarithmic scale";
  return text + ".";
}

std::size_t index_of(const Map& map, const std::string& component) {
  const auto found = std::find(map.components.begin(), map.components.end(), component);
  return found == map.components.end() ? 0
                                       : static_cast<std::size_t>(found - map.components.begin());
}

}  // namespace

std::string map_picture(const Map& map, std::size_t component, const ColourScale& scale,
                        const ImageFinding* found) {
  return preview({map, component, found}, scale);
}

std::string image_section(const Test& test) {
  if (!test.image || test.maps.empty()) return {};
  const ImageFinding& winner = test.image->winner;
  std::string out = "<div class=\"figures\">\n";
  for (const Map& map : test.maps) {
    if (map.texels.values.empty()) continue;
    const std::size_t worst = index_of(map, winner.component);
    for (std::size_t c = 0; c < map.components.size(); ++c) {
      // Every component has its z; other maps show the component that matters most.
      if (map.name != "z" && c != worst) continue;
      const bool outlined = map.name == "z" && c == worst && winner.width > 0;
      const Shown shown{map, c, outlined ? &winner : nullptr};
      out += figure(preview(shown, scale_of(map)), caption(shown));
    }
  }
  out += "</div>\n";
  HtmlTable table({{"sums over the image: the largest of each size"},
                   {"p of this sum", true},
                   {"p in the family", true}},
                  "small cards");
  for (const ImageFinding& group : test.image->groups) {
    table.row({{escape_xml(one_line(group.place))},
               {p_text({}, group.log10_p)},
               {p_text({}, group.log10_p_adjusted)}});
  }
  return out + table.finish();
}

}  // namespace assay::reports
