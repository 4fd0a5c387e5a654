#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/charts.h"
#include "reports/number.h"
#include "reports/svg.h"

namespace assay::reports {
namespace {

constexpr double plot_width = 520;
constexpr double row_height = 26;
constexpr double top = 34;

// Effects in the unit of the axis: per cent where relative.
struct Unit {
  double factor = 1;
  explicit Unit(const Effect& effect) : factor(effect.relative ? 100 : 1) {}
  Number operator()(Number value) const { return value ? Number(factor * *value) : std::nullopt; }
  Estimate operator()(const Effect& e) const {
    return {(*this)(e.estimate), (*this)(e.low), (*this)(e.high)};
  }
};

// Which sides a margin is drawn on: an inequality has one.
struct Sides {
  bool below, above;
  explicit Sides(const Test& test) : below(test.tail != "upper"), above(test.tail != "lower") {}
};

std::size_t shown(const Test& test) {
  return std::min(test.channels.size(), most_in_interval_chart);
}

Range domain(const Test& test, std::size_t channels) {
  const Unit unit(test.channels.front().effect);
  const Sides sides(test);
  Extent extent;
  extent.include(0.0);
  for (const Number& margin : {test.detect, test.allow}) {
    if (!margin) continue;
    if (sides.above) extent.include(unit(margin));
    if (sides.below) extent.include(unit(-*margin));
  }
  for (std::size_t i = 0; i < channels; ++i) {
    const Estimate effect = unit(test.channels[i].effect);
    extent.include(effect.value);
    extent.include(effect.low);
    extent.include(effect.high);
  }
  return extent.padded(0.06);
}

struct Frame {
  Scale scale;
  Range vertical;
};

void draw_margin(Svg& svg, const Frame& frame, double value, const char* style) {
  const double x = frame.scale(value);
  svg.line({x, frame.vertical.low}, {x, frame.vertical.high}, style);
}

void draw_margins(Svg& svg, const Test& test, const Frame& frame) {
  const Unit unit(test.channels.front().effect);
  const Sides sides(test);
  if (const Number allow = unit(test.allow); allow && *allow > 0) {
    const double left = frame.scale(sides.below ? -*allow : frame.scale.definition().domain.low);
    const double right = frame.scale(sides.above ? *allow : frame.scale.definition().domain.high);
    svg.box({left, frame.vertical.low, right - left, frame.vertical.high - frame.vertical.low},
            "allowed");
  }
  if (const Number detect = unit(test.detect)) {
    if (sides.above) draw_margin(svg, frame, *detect, "detect");
    if (sides.below) draw_margin(svg, frame, -*detect, "detect");
  }
  draw_margin(svg, frame, 0, "zero");
}

void draw_effect(Svg& svg, const Effect& effect, const Scale& scale, double y) {
  const Estimate shown = Unit(effect)(effect);
  horizontal_whisker(svg, scale, {.estimate = shown, .across = y, .cap = 5}, "interval");
  if (shown.value && std::isfinite(*shown.value)) svg.dot({scale(*shown.value), y}, "estimate");
}

// Names above the lines, where they do not run into each other.
void label_margins(Svg& svg, const Test& test, const Scale& scale) {
  const Unit unit(test.channels.front().effect);
  const Sides sides(test);
  std::vector<Range> taken;
  const auto label = [&](double value, const std::string& text) {
    const double x = scale(value), half = text_width(text) / 2 + 4;
    for (const Range& other : taken) {
      if (x + half > other.low && x - half < other.high) return;
    }
    taken.push_back({x - half, x + half});
    svg.text({.at = {x, top - 8}, .content = text, .anchor = Anchor::middle});
  };
  label(0, "0");
  const Number detect = unit(test.detect);
  if (detect && sides.above) label(*detect, "+detect");
  if (detect && sides.below) label(-*detect, "-detect");
}

double label_room(const Test& test) {
  double widest = 20;
  for (std::size_t i = 0; i < shown(test); ++i)
    widest = std::max(widest, text_width(test.channels[i].name));
  return std::min(widest, 150.0);
}

}  // namespace

std::string interval_chart(const Test& test) {
  if (test.channels.empty() || !test.channels.front().effect.estimate) return {};
  const std::size_t rows = shown(test);
  const double labels = label_room(test) + 34;
  const double bottom = top + row_height * static_cast<double>(rows);
  const Effect& effect = test.channels.front().effect;
  const Scale scale({domain(test, rows), {labels, labels + plot_width}});
  Svg svg({labels + plot_width + 40, bottom + 2 * line_height + 8},
          fmt::format("{}: {}", effect.quantity, test.name));
  horizontal_axis(svg, {.scale = scale,
                        .at = bottom,
                        .across = {top, bottom},
                        .title = effect.quantity + (effect.relative ? " (%)" : ""),
                        .ticks = 6});
  draw_margins(svg, test, {scale, {top, bottom}});
  label_margins(svg, test, scale);
  for (std::size_t i = 0; i < rows; ++i) {
    const double y = top + row_height * (static_cast<double>(i) + 0.5);
    svg.text({.at = {labels - 10, y + 4},
              .content = test.channels[i].name,
              .anchor = Anchor::end,
              .room = labels - 14});
    draw_effect(svg, test.channels[i].effect, scale, y);
  }
  return svg.finish();
}

std::string interval_sketch(const Test& test) {
  if (test.channels.empty() || !test.channels.front().effect.estimate) return {};
  constexpr Size size = {130, 20};
  const Scale scale({domain(test, 1), {6, size.width - 6}});
  Svg svg(size, "effect against zero and detect");
  draw_margins(svg, test, {scale, {1, size.height - 1}});
  draw_effect(svg, test.channels.front().effect, scale, size.height / 2);
  return svg.finish();
}

}  // namespace assay::reports
