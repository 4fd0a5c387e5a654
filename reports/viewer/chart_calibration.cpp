#include <fmt/format.h>

#include <algorithm>

#include "reports/record/calibration.h"
#include "reports/viewer/svg.h"
#include "reports/words/number.h"

namespace assay::reports {
namespace {

constexpr double label_width = 270;
constexpr double plot_width = 560;
constexpr double row_height = 15;
constexpr double heading_height = 22;
constexpr double top = 40;
constexpr Range ratios{0.02, 200};

struct Row {
  const CalibrationCell* cell;
  double y;
  bool first_of_question;
};

std::vector<Row> rows_of(const Calibration& calibration, double alpha, double& bottom) {
  std::vector<Row> rows;
  std::string question;
  bottom = top;
  for (const CalibrationCell& cell : calibration.cells) {
    if (cell.alpha != alpha) continue;
    const bool first = cell.method + cell.question != question;
    question = cell.method + cell.question;
    if (first) bottom += heading_height;
    rows.push_back({&cell, bottom + row_height / 2, first});
    bottom += row_height;
  }
  return rows;
}

Number ratio(double rate, double alpha) { return rate > 0 ? Number(rate / alpha) : std::nullopt; }

/// A rate that was never met has an upper limit only: an arrow from the axis's end.
void draw_rate(Svg& svg, const Scale& scale, const Row& row, const Rate& rate, const char* style) {
  if (rate.runs == 0) return;
  const double alpha = row.cell->alpha;
  const Estimate estimate{ratio(rate.value(), alpha), ratio(rate.low, alpha),
                          ratio(rate.high, alpha)};
  const bool alone = std::string_view(style) == "second";
  horizontal_whisker(svg, scale, {.estimate = estimate, .across = row.y, .cap = 3},
                     alone ? "second" : "interval");
  if (estimate.value) svg.dot({scale(*estimate.value), row.y}, alone ? "second" : "estimate");
}

void draw_row(Svg& svg, const Scale& scale, const Row& row) {
  const CalibrationCell& cell = *row.cell;
  if (row.first_of_question) {
    svg.text({.at = {4, row.y - row_height / 2 - 4},
              .content = cell.method + ": " + cell.question,
              .style = "title"});
  }
  const auto share = [](const Rate& rate) {
    return fmt::format("{:.3g} ({:.2g} to {:.2g})", rate.value(), rate.low, rate.high);
  };
  std::string tooltip = fmt::format("alone {}", share(cell.alone));
  if (cell.mistaken.runs > 0) {
    tooltip = fmt::format("procedure {}, {}", share(cell.mistaken), tooltip);
  }
  svg.text({.at = {label_width - 8, row.y + 4},
            .content = cell.law,
            .anchor = Anchor::end,
            .room = label_width - 20,
            .tooltip = tooltip});
  draw_rate(svg, scale, row, cell.alone, "second");
  draw_rate(svg, scale, row, cell.mistaken, "first");
}

}  // namespace

std::string calibration_chart(const Calibration& calibration, double alpha) {
  double bottom = top;
  const std::vector<Row> rows = rows_of(calibration, alpha, bottom);
  if (rows.empty()) return {};
  Svg svg({label_width + plot_width + 20, bottom + 2 * line_height + 10},
          fmt::format("Rates of mistakes over alpha = {:g}", alpha));
  const Scale scale({ratios, {label_width, label_width + plot_width}, Scale::Kind::logarithmic});
  horizontal_axis(svg,
                  {.scale = scale,
                   .at = bottom,
                   .across = {top, bottom},
                   .title = fmt::format("rate of mistakes over alpha = {:g}, log scale", alpha),
                   .ticks = 5});
  svg.line({scale(1), top}, {scale(1), bottom}, "zero");
  const double limit = scale(calibration.tolerance);
  svg.line({limit, top}, {limit, bottom}, "detect");
  svg.dot({label_width, 14}, "estimate");
  svg.text({.at = {label_width + 10, 18}, .content = "whole procedure", .style = "title"});
  svg.dot({label_width + 160, 14}, "second");
  svg.text({.at = {label_width + 170, 18}, .content = "method alone", .style = "title"});
  svg.text({.at = {label_width + 300, 18},
            .content = fmt::format("dashed: {:g} alpha", calibration.tolerance),
            .style = "title"});
  for (const Row& row : rows) draw_row(svg, scale, row);
  return svg.finish();
}

}  // namespace assay::reports
