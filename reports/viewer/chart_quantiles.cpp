#include <fmt/format.h>

#include <cmath>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"

namespace assay::reports {
namespace {

constexpr double left = 78;
constexpr double top = 58;
constexpr Size plot = {188, 190};
constexpr double bottom = top + plot.height;

std::string points(const Sample& sample, const Scale& x, const Scale& y) {
  std::string data;
  for (const QuantilePoint& point : sample.quantiles) {
    if (std::isfinite(point.normal) && std::isfinite(point.observed))
      data += fmt::format("M{} {}h0", coordinate(x(point.normal)), coordinate(y(point.observed)));
  }
  return data;
}

// The part of observed = mean + deviation * z that lies inside the plot.
void normal_line(Svg& svg, const Sample& sample, const Scale& x, const Scale& y) {
  if (!sample.mean || !sample.variance || !std::isfinite(*sample.mean) ||
      !std::isfinite(*sample.variance) || *sample.variance <= 0)
    return;
  const double deviation = std::sqrt(*sample.variance);
  Range z = x.definition().domain;
  const Range inside = y.definition().domain;
  z.low = std::max(z.low, (inside.low - *sample.mean) / deviation);
  z.high = std::min(z.high, (inside.high - *sample.mean) / deviation);
  if (!(z.low < z.high)) return;
  svg.line({x(z.low), y(*sample.mean + deviation * z.low)},
           {x(z.high), y(*sample.mean + deviation * z.high)}, "normal");
}

}  // namespace

std::string quantile_chart(const Sample& sample) {
  Extent across, up;
  for (const QuantilePoint& point : sample.quantiles) {
    across.include(point.normal);
    up.include(point.observed);
  }
  if (across.empty() || up.empty()) return {};
  const Scale x({across.padded(0.05), {left, left + plot.width}});
  const Scale y({up.padded(0.05), {bottom, top}});
  Svg svg({left + plot.width + 20, bottom + 2 * line_height + 8},
          fmt::format("Normal quantile plot of {}", sample.estimator));
  horizontal_axis(svg, {.scale = x,
                        .at = bottom,
                        .across = {top, bottom},
                        .title = "standard normal quantile",
                        .ticks = 4});
  vertical_axis(svg, {.scale = y,
                      .at = left,
                      .across = {left, left + plot.width},
                      .title = "observed",
                      .ticks = 4});
  svg.text({.at = {left, 14}, .content = sample.estimator, .room = plot.width});
  normal_line(svg, sample, x, y);
  svg.path(points(sample, x, y), "points");
  return svg.finish();
}

}  // namespace assay::reports
