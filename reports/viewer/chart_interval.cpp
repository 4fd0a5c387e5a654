#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"
#include "reports/words/effect.h"
#include "reports/words/evidence.h"

namespace assay::reports {
namespace {

constexpr double plot_width = 520;
constexpr double row_height = 26;
constexpr double top = 34;

// Effects in the unit of the axis: per cent where relative, the ratio where theta is its logarithm.
class Unit {
 public:
  explicit Unit(const Effect& effect) : relative_(effect.relative), ratio_(is_ratio(effect)) {}

  Number operator()(Number value) const {
    if (!value || !std::isfinite(*value)) return std::nullopt;
    if (ratio_) return std::exp(std::clamp(*value, -most, most));
    return relative_ ? 100 * *value : *value;
  }
  Estimate operator()(const Effect& e) const {
    return {(*this)(e.estimate), (*this)(e.low), (*this)(e.high)};
  }
  double none() const { return ratio_ ? 1 : 0; }
  bool ratio() const { return ratio_; }

 private:
  static constexpr double most = 300;  // so that even the ratio of two ends is a double
  bool relative_;
  bool ratio_;
};

// Which sides a margin is drawn on: an inequality has one. What a proof of < or > is planned for
// lies on the side that is claimed, what an alarm must notice on the other.
struct Sides {
  bool below, above;
  explicit Sides(const Test& test) : below(test.tail != "upper"), above(test.tail != "lower") {
    const std::string relation = relation_of(test.claim);
    if (relation == "within") below = above = true;
    if (relation == "<" || relation == ">") {
      below = relation == "<";
      above = relation == ">";
    }
  }
};

std::size_t shown(const Test& test) {
  return std::min(test.channels.size(), most_in_interval_chart);
}

Extent extent_of(const Test& test, std::size_t channels) {
  const Unit unit(test.channels.front().effect);
  const Sides sides(test);
  Extent extent;
  extent.include(unit.none());
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
  return extent;
}

// Ratios that span more than a factor of three are told apart on a logarithmic axis only.
Scale scale_of(const Test& test, std::size_t channels, Range pixels) {
  const Extent extent = extent_of(test, channels);
  const Range range = extent.range();
  if (Unit(test.channels.front().effect).ratio() && range.low > 0 && range.high > 3 * range.low) {
    const double margin = std::pow(range.high / range.low, 0.06);
    return Scale({{range.low / margin, range.high * margin}, pixels, Scale::Kind::logarithmic});
  }
  return Scale({extent.padded(0.06), pixels});
}

// The places of `detect` on the axis: one or two.
std::vector<double> detect_margins(const Test& test) {
  const Unit unit(test.channels.front().effect);
  const Sides sides(test);
  std::vector<double> margins;
  if (!test.detect || !std::isfinite(*test.detect)) return margins;
  if (sides.above) margins.push_back(*unit(test.detect));
  if (sides.below) margins.push_back(*unit(-*test.detect));
  return margins;
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
  if (test.allow.value_or(0) > 0) {
    const Range domain = frame.scale.definition().domain;
    const double left = frame.scale(sides.below ? unit(-*test.allow).value_or(0) : domain.low);
    const double right = frame.scale(sides.above ? unit(test.allow).value_or(0) : domain.high);
    svg.box({left, frame.vertical.low, right - left, frame.vertical.high - frame.vertical.low},
            "allowed");
  }
  for (const double margin : detect_margins(test)) draw_margin(svg, frame, margin, "detect");
  draw_margin(svg, frame, unit.none(), "zero");
}

void draw_effect(Svg& svg, const Effect& effect, const Scale& scale, double y) {
  const Estimate shown = Unit(effect)(effect);
  horizontal_whisker(svg, scale, {.estimate = shown, .across = y, .cap = 5}, "interval");
  if (shown.value && std::isfinite(*shown.value)) svg.dot({scale(*shown.value), y}, "estimate");
}

// Names above the lines, where they do not run into each other.
void label_margins(Svg& svg, const Test& test, const Scale& scale) {
  const Unit unit(test.channels.front().effect);
  std::vector<Range> taken;
  const auto label = [&](double value, const std::string& text) {
    const double x = scale(value), half = text_width(text) / 2 + 4;
    for (const Range& other : taken) {
      if (x + half > other.low && x - half < other.high) return;
    }
    taken.push_back({x - half, x + half});
    svg.text({.at = {x, top - 8}, .content = text, .anchor = Anchor::middle});
  };
  label(unit.none(), unit.ratio() ? "1" : "0");
  const char* name = relation_of(test.claim) == "within" ? "margin" : "detect";
  for (const double margin : detect_margins(test))
    label(margin, unit.ratio() ? name : fmt::format("{}{}", margin < 0 ? "-" : "+", name));
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
  const Scale scale = scale_of(test, rows, {labels, labels + plot_width});
  const bool logarithmic = scale.definition().kind == Scale::Kind::logarithmic;
  Svg svg({labels + plot_width + 40, bottom + 2 * line_height + 8},
          fmt::format("{}: {}", effect_name(effect), test.name));
  horizontal_axis(svg, {.scale = scale,
                        .at = bottom,
                        .across = {top, bottom},
                        .title = effect_name(effect) + (effect.relative ? " (%)"
                                                        : logarithmic   ? ", log scale"
                                                                        : ""),
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
  if (test.channels.empty() || !deciding_channel(test).effect.estimate) return {};
  constexpr Size size = {130, 20};
  const Scale scale = scale_of(test, test.channels.size(), {6, size.width - 6});
  Svg svg(size, "the effect; solid line: no effect, dashed: detect");
  draw_margins(svg, test, {scale, {1, size.height - 1}});
  draw_effect(svg, deciding_channel(test).effect, scale, size.height / 2);
  return svg.finish();
}

}  // namespace assay::reports
