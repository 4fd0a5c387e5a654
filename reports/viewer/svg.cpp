#include "reports/viewer/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/words/columns.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

// Monospaced faces advance by 0.55 to 0.61 of their size; chart text is 11 pixels.
constexpr double column_width = 6.7;

const char* anchor_name(Anchor anchor) {
  switch (anchor) {
    case Anchor::start:
      return "start";
    case Anchor::middle:
      return "middle";
    case Anchor::end:
      break;
  }
  return "end";
}

std::string tooltip_element(std::string_view tooltip) {
  return tooltip.empty() ? std::string()
                         : fmt::format("<title>{}</title>", escape_xml(one_line(tooltip)));
}

bool finite(const Number& value) { return value && std::isfinite(*value); }

}  // namespace

double text_width(std::string_view text) { return column_width * columns(text); }

std::string coordinate(double value) {
  if (std::isnan(value)) return "0";
  std::string text = fmt::format("{:.1f}", std::clamp(value, -1e5, 1e5));
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

Svg::Svg(Size size, std::string_view title)
    : out_(fmt::format("<svg class=\"chart\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
                       "role=\"img\" aria-label=\"{2}\">\n",
                       coordinate(size.width), coordinate(size.height),
                       escape_attribute(one_line(title)))) {}

void Svg::line(Point from, Point to, const char* style) {
  out_ += fmt::format("<line class=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>\n", style,
                      coordinate(from.x), coordinate(from.y), coordinate(to.x), coordinate(to.y));
}

void Svg::box(Box box, const char* style, std::string_view tooltip) {
  out_ +=
      fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">{}</rect>\n",
                  style, coordinate(box.x), coordinate(box.y), coordinate(std::max(box.width, 0.0)),
                  coordinate(std::max(box.height, 0.0)), tooltip_element(tooltip));
}

void Svg::image(Box box, std::string_view address) {
  out_ += fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "href=\"{}\"/>\n",
      coordinate(box.x), coordinate(box.y), coordinate(box.width), coordinate(box.height),
      escape_attribute(address));
}

void Svg::text(const Text& text) {
  const std::string full = one_line(text.content);
  const std::string shown =
      shorten(full, static_cast<int>(std::min(text.room, 1e6) / column_width));
  const std::string tooltip = text.tooltip.empty() && shown != full ? full : text.tooltip;
  out_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}{}</text>\n",
                      text.style, coordinate(text.at.x), coordinate(text.at.y),
                      anchor_name(text.anchor), tooltip_element(tooltip), escape_xml(shown));
}

void Svg::path(std::string_view data, const char* style) {
  if (!data.empty()) out_ += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", style, data);
}

void Svg::dot(Point at, const char* style) {
  out_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"3.5\"/>\n", style,
                      coordinate(at.x), coordinate(at.y));
}

std::string Svg::finish() { return out_ + "</svg>\n"; }

void horizontal_axis(Svg& svg, const Axis& axis) {
  const Range pixels = axis.scale.definition().pixels;
  for (const Tick& tick : axis.scale.ticks(axis.ticks)) {
    const double x = axis.scale(tick.value);
    svg.line({x, axis.across.low}, {x, axis.across.high}, "grid");
    svg.line({x, axis.at}, {x, axis.at + 4}, "axis");
    svg.text({.at = {x, axis.at + line_height}, .content = tick.label, .anchor = Anchor::middle});
  }
  svg.line({pixels.low, axis.at}, {pixels.high, axis.at}, "axis");
  svg.text({.at = {(pixels.low + pixels.high) / 2, axis.at + 2 * line_height + 1},
            .content = axis.title,
            .anchor = Anchor::middle,
            .style = "title"});
}

void vertical_axis(Svg& svg, const Axis& axis) {
  const Range pixels = axis.scale.definition().pixels;
  for (const Tick& tick : axis.scale.ticks(axis.ticks)) {
    const double y = axis.scale(tick.value);
    svg.line({axis.across.low, y}, {axis.across.high, y}, "grid");
    svg.line({axis.at - 4, y}, {axis.at, y}, "axis");
    svg.text({.at = {axis.at - 6, y + 4}, .content = tick.label, .anchor = Anchor::end});
  }
  svg.line({axis.at, pixels.low}, {axis.at, pixels.high}, "axis");
  svg.text(
      {.at = {4, std::min(pixels.low, pixels.high) - 8}, .content = axis.title, .style = "title"});
}

void horizontal_whisker(Svg& svg, const Scale& scale, const Whisker& whisker, const char* style) {
  const auto& [value, low, high] = whisker.estimate;
  if (!low && !high) return;
  const Range domain = scale.definition().domain;
  const double y = whisker.across, cap = whisker.cap;
  const bool left_closed = finite(low) && *low >= domain.low;
  const bool right_closed = finite(high) && *high <= domain.high;
  const double left = scale(finite(low) ? *low : domain.low);
  const double right = scale(finite(high) ? *high : domain.high);
  std::string data = fmt::format("M{} {}H{}", coordinate(left), coordinate(y), coordinate(right));
  const auto end = [&](double x, double inwards) {
    data += inwards == 0
                ? fmt::format("M{} {}v{}", coordinate(x), coordinate(y - cap), coordinate(2 * cap))
                : fmt::format("M{} {}l{} {}l{} {}", coordinate(x + inwards), coordinate(y - cap),
                              coordinate(-inwards), coordinate(cap), coordinate(inwards),
                              coordinate(cap));
  };
  end(left, left_closed ? 0 : cap);
  end(right, right_closed ? 0 : -cap);
  svg.path(data, style);
}

}  // namespace assay::reports
