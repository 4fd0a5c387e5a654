#include "reports/viewer/colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace assay::reports {
namespace {

struct Colour {
  double red, green, blue;
};

// Dark blue, light blue, white, orange, dark red: told apart by readers who see no red or green,
// and by lightness from the middle on.
constexpr std::array<Colour, 5> difference = {
    {{5, 48, 97}, {103, 169, 207}, {255, 255, 255}, {239, 138, 98}, {128, 0, 20}}};
constexpr std::array<Colour, 2> brightness = {{{0, 0, 0}, {255, 255, 255}}};
constexpr std::array<Colour, 3> evidence = {{{48, 0, 80}, {150, 110, 190}, {255, 255, 255}}};

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

template <std::size_t count>
Rgb along(const std::array<Colour, count>& stops, double share) {
  const double place = share * static_cast<double>(count - 1);
  const auto first = std::min(static_cast<std::size_t>(place), count - 2);
  const double t = place - static_cast<double>(first);
  const auto mix = [&](double a, double b) { return byte(a + t * (b - a)); };
  const Colour& a = stops[first];
  const Colour& b = stops[first + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

}  // namespace

Rgb ColourScale::operator()(double value) const {
  const double shown = palette == Palette::evidence ? std::log10(std::max(value, low)) : value;
  const double from = palette == Palette::evidence ? std::log10(low) : low;
  const double to = palette == Palette::evidence ? std::log10(high) : high;
  const double share = to > from ? (shown - from) / (to - from) : 0;
  const double inside = std::isnan(share) ? 0 : std::clamp(share, 0.0, 1.0);
  switch (palette) {
    case Palette::difference:
      return along(difference, inside);
    case Palette::evidence:
      return along(evidence, inside);
    case Palette::brightness:
      break;
  }
  return along(brightness, inside);
}

ColourScale scale_of(const Map& map) {
  if (map.name == "p_adjusted") return {Palette::evidence, 1e-6, 1};
  double low = 0;
  double high = 0;
  for (const float value : map.texels.values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, static_cast<double>(value));
    high = std::max(high, static_cast<double>(value));
  }
  if (map.name != "z" && !map.name.starts_with("cells_z"))
    return {Palette::brightness, low, high > low ? high : low + 1};
  const double limit = std::clamp(std::ceil(std::max(high, -low)), 5.0, 15.0);
  return {Palette::difference, -limit, limit};
}

Pixels picture_of(const Map& map, std::size_t component, const ColourScale& scale) {
  Pixels pixels{map.width, map.height, {}};
  pixels.rows.reserve(map.width * map.height);
  for (std::size_t i = component; i < map.texels.values.size(); i += map.components.size()) {
    pixels.rows.push_back(scale(static_cast<double>(map.texels.values[i])));
  }
  return pixels;
}

}  // namespace assay::reports
