#include <fmt/format.h>

#include <cmath>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"
#include "reports/words/number.h"

namespace assay::reports {
namespace {

constexpr double left = 62;
constexpr double top = 58;
constexpr Size plot = {336, 190};
constexpr double bottom = top + plot.height;

struct Axes {
  const Scale& x;
  const Scale& y;

  std::string at(double value, double part) const {
    return fmt::format("{} {}", coordinate(x(value)), coordinate(y(part)));
  }
};

bool drawable(const EmpiricalLaw& law) {
  if (law.points.size() < 2) return false;
  for (const LawPoint& point : law.points) {
    if (!std::isfinite(point.value) || !std::isfinite(point.observed)) return false;
  }
  return true;
}

/// Out along the upper ends, back along the lower ones.
std::string band(const EmpiricalLaw& law, const Axes& axes) {
  std::string data;
  for (const LawPoint& point : law.points) {
    data += (data.empty() ? "M" : "L") + axes.at(point.value, point.high);
  }
  for (auto point = law.points.rbegin(); point != law.points.rend(); ++point) {
    data += "L" + axes.at(point->value, point->low);
  }
  return data + "Z";
}

/// Through the points where `part` says something.
template <class Part>
std::string curve(const EmpiricalLaw& law, const Axes& axes, Part part) {
  std::string data;
  for (const LawPoint& point : law.points) {
    const Number height = part(point);
    if (!height || !std::isfinite(*height)) continue;
    data += (data.empty() ? "M" : "L") + axes.at(point.value, *height);
  }
  return data;
}

struct Style {
  const char* band;
  const char* curve;
  double legend_y;
};

void draw(Svg& svg, const EmpiricalLaw& law, const Axes& axes, const Style& style) {
  svg.path(band(law, axes), style.band);
  svg.path(curve(law, axes, [](const LawPoint& p) { return Number(p.observed); }), style.curve);
  svg.box({left, style.legend_y - 9, 12, 10}, style.band);
  svg.text({.at = {left + 18, style.legend_y}, .content = law.source, .room = plot.width - 18});
  const std::string claimed = curve(law, axes, [](const LawPoint& p) { return p.law; });
  if (!claimed.empty()) svg.path(claimed, "law");
}

}  // namespace

std::string law_chart(const Channel& channel) {
  Extent across;
  for (const EmpiricalLaw& law : channel.laws) {
    if (!drawable(law)) return {};
    for (const LawPoint& point : law.points) across.include(point.value);
  }
  if (across.empty() || channel.laws.size() > 2) return {};
  const Scale x({across.padded(0.02), {left, left + plot.width}});
  const Scale y({{0, 1}, {bottom, top}});
  Svg svg({left + plot.width + 24, bottom + 2 * line_height + 8},
          "Empirical distribution functions with simultaneous bands");
  horizontal_axis(
      svg,
      {.scale = x, .at = bottom, .across = {top, bottom}, .title = "one observation", .ticks = 5});
  vertical_axis(svg, {.scale = y,
                      .at = left,
                      .across = {left, left + plot.width},
                      .title = "part of the values up to here",
                      .ticks = 4});
  draw(svg, channel.laws[0], {x, y}, {"bandfirst", "curvefirst", 14});
  if (channel.laws.size() > 1) {
    draw(svg, channel.laws[1], {x, y}, {"bandsecond", "curvesecond", 14 + line_height});
  }
  return svg.finish();
}

}  // namespace assay::reports
