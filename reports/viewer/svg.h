#pragma once

// Inline SVG, written by hand. Colours and line styles are classes of the page's style sheet, so
// that a chart follows light, dark and print. Chart text is set in a monospaced face of known
// width, so that what fits here fits in every browser.

#include <string>
#include <string_view>

#include "reports/viewer/scale.h"

namespace assay::reports {

struct Point {
  double x = 0;
  double y = 0;
};

struct Box {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

struct Size {
  double width = 0;
  double height = 0;
};

enum class Anchor { start, middle, end };

struct Text {
  Point at;
  std::string content;
  Anchor anchor = Anchor::start;
  const char* style = "";
  double room = 1e9;         ///< pixels; the text is shortened to fit
  std::string tooltip = {};  ///< shown on hovering; the full text where it was shortened
};

/// Pixels that a text of chart size takes at most.
double text_width(std::string_view text);

/// Height of a line of chart text in pixels.
inline constexpr double line_height = 15;

class Svg {
 public:
  /// `title` is the chart's name for those who cannot see it.
  Svg(Size size, std::string_view title);

  void line(Point from, Point to, const char* style);
  /// A picture by its address (`data:…`), stretched to the box; its pixels stay squares of one
  /// colour.
  void image(Box box, std::string_view address);
  void box(Box box, const char* style, std::string_view tooltip = {});
  void text(const Text& text);
  /// `data` in SVG's path language.
  void path(std::string_view data, const char* style);
  void dot(Point at, const char* style);

  std::string finish();

 private:
  std::string out_;
};

/// A coordinate: one decimal, never "nan".
std::string coordinate(double value);

struct Axis {
  Scale scale;
  double at = 0;  ///< position across: y of a horizontal axis, x of a vertical one
  Range across;   ///< what the grid lines span
  std::string title;
  int ticks = 5;
};

/// An axis with ticks, grid lines, labels below and its title below those.
void horizontal_axis(Svg& svg, const Axis& axis);

/// An axis with ticks, grid lines, labels to the left; its title stands above, left aligned.
void vertical_axis(Svg& svg, const Axis& axis);

/// An interval as a line with end caps; an end that is missing or not finite is an arrow to the
/// axis's end.
struct Whisker {
  Estimate estimate;
  double across = 0;  ///< y of a horizontal whisker
  double cap = 4;     ///< half height of the end caps
};
void horizontal_whisker(Svg& svg, const Scale& scale, const Whisker& whisker, const char* style);

}  // namespace assay::reports
