#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"
#include "reports/words/describe.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr double row_height = 24;
constexpr double bar_height = 13;
constexpr double panel_width = 265;
constexpr double value_width = 78;
constexpr double top = 26;
constexpr double log_from = 50;

struct Row {
  const EstimatorSummary* estimator;
  const EstimatorChannel* channel;
};

std::vector<Row> rows_of(const Suite& suite, const std::string& name) {
  std::vector<Row> rows;
  for (const EstimatorSummary& estimator : suite.estimators) {
    for (const EstimatorChannel& channel : estimator.channels) {
      if (channel.name == name) rows.push_back({&estimator, &channel});
    }
  }
  return rows;
}

// The part of a row that one panel shows.
struct Bar {
  Estimate estimate;
  Number reference;
};

struct Panel {
  std::string title;
  const char* unit;
  const char* style;
  std::function<Bar(const EstimatorChannel&)> bar;
  double left = 0;
  bool may_be_logarithmic = false;
};

std::optional<Range> positive_range(const std::vector<Row>& rows, const Panel& panel) {
  Extent extent;
  for (const Row& row : rows) {
    const Bar bar = panel.bar(*row.channel);
    for (const Number& value : {bar.estimate.value, bar.reference}) {
      if (value && *value > 0) extent.include(value);
    }
  }
  if (extent.empty()) return std::nullopt;
  return extent.range();
}

// Whole decades, with the least value at least a third of a decade above the axis's start.
Range decades(Range range) {
  const double low = std::floor(std::log10(range.low) - 0.3);
  const double high = std::ceil(std::log10(range.high) + 0.05);
  return {std::pow(10.0, std::max(low, -300.0)), std::pow(10.0, std::min(high, 300.0))};
}

Scale panel_scale(const std::vector<Row>& rows, const Panel& panel) {
  const Range pixels = {panel.left, panel.left + panel_width};
  if (panel.may_be_logarithmic) {
    const auto positive = positive_range(rows, panel);
    if (positive && positive->low > 0 && positive->high > log_from * positive->low)
      return Scale({decades(*positive), pixels, Scale::Kind::logarithmic});
  }
  Extent extent;
  extent.include(0.0);
  for (const Row& row : rows) {
    const Bar bar = panel.bar(*row.channel);
    for (const Number& value :
         {bar.estimate.value, bar.estimate.low, bar.estimate.high, bar.reference})
      extent.include(value);
  }
  Range domain = extent.range();
  const double margin = 0.04 * (domain.high - domain.low);
  if (domain.high > 0) domain.high += margin;
  if (domain.low < 0) domain.low -= margin;
  return Scale({domain, pixels, Scale::Kind::linear});
}

void draw_bar(Svg& svg, const Panel& panel, const Scale& scale, Point row, const Bar& bar) {
  const bool logarithmic = scale.definition().kind == Scale::Kind::logarithmic;
  const double middle = row.y + row_height / 2;
  const Number value = bar.estimate.value;
  if (value && std::isfinite(*value)) {
    const double base = scale(logarithmic ? scale.definition().domain.low : 0);
    const double end = scale(*value);
    svg.box({std::min(base, end), middle - bar_height / 2, std::abs(end - base), bar_height},
            panel.style);
    const auto& [estimate, low, high] = bar.estimate;
    if (low || high)
      horizontal_whisker(svg, scale, {.estimate = bar.estimate, .across = middle}, "whisker");
  }
  if (bar.reference && std::isfinite(*bar.reference) && !(logarithmic && *bar.reference <= 0)) {
    const double x = scale(*bar.reference);
    svg.line({x, row.y}, {x, row.y + row_height}, "reference");
  }
  svg.text({.at = {panel.left + panel_width + 8, middle + 4},
            .content = data_text(value),
            .room = value_width});
}

void draw_panel(Svg& svg, const std::vector<Row>& rows, const Panel& panel) {
  const Scale scale = panel_scale(rows, panel);
  const double bottom = top + row_height * static_cast<double>(rows.size());
  const bool logarithmic = scale.definition().kind == Scale::Kind::logarithmic;
  horizontal_axis(svg, {.scale = scale,
                        .at = bottom,
                        .across = {top, bottom},
                        .title = fmt::format("{}{}", panel.unit, logarithmic ? ", log scale" : ""),
                        .ticks = 4});
  svg.box({panel.left, top - 18, 10, 10}, panel.style);
  svg.text({.at = {panel.left + 16, top - 9}, .content = panel.title, .style = "title"});
  double y = top;
  for (const Row& row : rows) {
    draw_bar(svg, panel, scale, {panel.left, y}, panel.bar(*row.channel));
    y += row_height;
  }
  if (!logarithmic) svg.line({scale(0), top}, {scale(0), bottom}, "axis");
}

std::string label_tooltip(const EstimatorSummary& estimator) {
  std::string text = fmt::format("{}: {} {}", estimator.name, estimator.plugin,
                                 parameters_text(estimator.parameters));
  if (!estimator.defect.empty()) text += fmt::format(" (mutant: {})", estimator.defect);
  return text;
}

// The title says if variances are of primary or secondary estimates, where all agree.
std::string variance_title(const std::vector<Row>& rows) {
  std::set<std::string> kinds;
  for (const Row& row : rows) kinds.insert(row.estimator->variance_of);
  if (kinds.size() == 1 && !kinds.begin()->empty())
    return fmt::format("variance of one {} estimate", one_line(*kinds.begin()));
  return kinds.size() > 1 ? "variance of one primary (p) or secondary (s)" : "variance";
}

std::string row_label(const Row& row, const Panel& panel, bool mixed) {
  const std::string& of = row.estimator->variance_of;
  const bool marked = mixed && panel.may_be_logarithmic && !of.empty();
  return marked ? fmt::format("{} ({})", row.estimator->name, of.substr(0, 1))
                : row.estimator->name;
}

double label_width(const std::vector<Row>& rows, const Panel& panel, bool mixed) {
  double widest = 60;
  for (const Row& row : rows) widest = std::max(widest, text_width(row_label(row, panel, mixed)));
  return std::min(widest, 170.0);
}

std::string bars(const Suite& suite, const std::string& channel, Panel panel) {
  const std::vector<Row> rows = rows_of(suite, channel);
  if (rows.empty()) return {};
  const bool mixed = panel.title.ends_with(" (s)");
  const double labels = label_width(rows, panel, mixed);
  panel.left = labels + 12;
  const double height = top + row_height * static_cast<double>(rows.size()) + 2 * line_height + 8;
  Svg svg({panel.left + panel_width + value_width + 8, height},
          fmt::format("{} of {} of {}: {}", panel.title,
                      counted(rows.size(), "estimator", "estimators"), suite.name, channel));
  double y = top + row_height / 2 + 4;
  for (const Row& row : rows) {
    svg.text({.at = {labels, y},
              .content = row_label(row, panel, mixed),
              .anchor = Anchor::end,
              .style = row.estimator->original.empty() ? "" : "mutant",
              .room = labels,
              .tooltip = label_tooltip(*row.estimator)});
    y += row_height;
  }
  draw_panel(svg, rows, panel);
  return svg.finish();
}

}  // namespace

std::string mean_bars(const Suite& suite, const std::string& channel) {
  return bars(suite, channel,
              {.title = "mean",
               .unit = "unit of the output",
               .style = "mean",
               .bar = [](const EstimatorChannel& c) {
                 return Bar{c.mean, c.reference};
               }});
}

std::string variance_bars(const Suite& suite, const std::string& channel) {
  return bars(suite, channel,
              {.title = variance_title(rows_of(suite, channel)),
               .unit = "squared unit of the output",
               .style = "variance",
               .bar =
                   [](const EstimatorChannel& c) {
                     return Bar{c.variance, c.reference_variance};
                   },
               .may_be_logarithmic = true});
}

}  // namespace assay::reports
