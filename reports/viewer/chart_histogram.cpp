#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"
#include "reports/words/number.h"

namespace assay::reports {
namespace {

constexpr double left = 62;
constexpr double top = 58;
constexpr Size plot = {336, 190};
constexpr double bottom = top + plot.height;

bool drawable(const Histogram& h) {
  return !h.counts.empty() && std::isfinite(h.low) && std::isfinite(h.high) && h.low < h.high &&
         std::isfinite(h.high - h.low);
}

double bin_width(const Histogram& h) {
  return (h.high - h.low) / static_cast<double>(h.counts.size());
}

// Heights of the bins: counts, or the density that makes samples of different size comparable.
std::vector<double> heights(const Histogram& h, bool density) {
  std::vector<double> result(h.counts.begin(), h.counts.end());
  if (!density) return result;
  const double total =
      std::accumulate(result.begin(), result.end(), 0.0) + static_cast<double>(h.below + h.above);
  const double scale = total * bin_width(h);
  for (double& height : result) height = scale > 0 ? height / scale : 0;
  return result;
}

std::string outline(const Histogram& h, const std::vector<double>& tops, const Scale& x,
                    const Scale& y) {
  std::string data = fmt::format("M{} {}", coordinate(x(h.low)), coordinate(bottom));
  for (std::size_t i = 0; i < tops.size(); ++i)
    data += fmt::format("V{}H{}", coordinate(y(tops[i])),
                        coordinate(x(h.low + static_cast<double>(i + 1) * bin_width(h))));
  return data + fmt::format("V{}", coordinate(bottom));
}

std::string outside(const Histogram& h) {
  std::string text;
  if (h.below > 0) text += fmt::format(", {} below", count_text(h.below));
  if (h.above > 0) text += fmt::format(", {} above", count_text(h.above));
  return text;
}

struct Series {
  const Sample* sample;
  std::vector<double> tops;
  const char* area;
  double legend_y;
};

void legend(Svg& svg, const Series& series) {
  svg.box({left, series.legend_y - 9, 12, 10}, series.area);
  svg.text({.at = {left + 18, series.legend_y},
            .content = series.sample->estimator + outside(series.sample->histogram),
            .room = plot.width - 18});
}

void mark(Svg& svg, const Scale& x, const Number& reference) {
  if (!reference || !std::isfinite(*reference)) return;
  const double at = x(*reference);
  svg.line({at, top}, {at, bottom}, "reference");
  const bool right_half = at > left + plot.width / 2;
  svg.text({.at = {right_half ? at - 5 : at + 5, top + 11},
            .content = "reference",
            .anchor = right_half ? Anchor::end : Anchor::start,
            .style = "over"});
}

}  // namespace

std::string histogram_chart(const Observations& observations) {
  std::vector<Series> all;
  for (const Sample* sample : observations.samples) {
    if (drawable(sample->histogram) && all.size() < 2)
      all.push_back({sample,
                     {},
                     all.empty() ? "first" : "second",
                     14 + line_height * static_cast<double>(all.size())});
  }
  if (all.empty()) return {};
  Extent across, up;
  up.include(0.0);
  across.include(observations.reference);
  for (Series& series : all) {
    series.tops = heights(series.sample->histogram, all.size() > 1);
    across.include(series.sample->histogram.low);
    across.include(series.sample->histogram.high);
    for (const double height : series.tops) up.include(height);
  }
  const Range y_range = {0, std::max(up.range().high * 1.08, 1e-290)};
  const Scale x({across.padded(0.02), {left, left + plot.width}});
  const Scale y({y_range, {bottom, top}});
  Svg svg({left + plot.width + 24, bottom + 2 * line_height + 8}, "Histogram of observations");
  horizontal_axis(svg, {.scale = x,
                        .at = bottom,
                        .across = {bottom, bottom},
                        .title = "one observation",
                        .ticks = 5});
  vertical_axis(svg, {.scale = y,
                      .at = left,
                      .across = {left, left + plot.width},
                      .title = all.size() > 1 ? "density" : "count",
                      .ticks = 4});
  for (const Series& series : all) {
    svg.path(outline(series.sample->histogram, series.tops, x, y), series.area);
    legend(svg, series);
  }
  mark(svg, x, observations.reference);
  return svg.finish();
}

}  // namespace assay::reports
