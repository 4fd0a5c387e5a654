#include <fmt/format.h>

#include <algorithm>

#include "reports/record/groups.h"
#include "reports/viewer/charts.h"
#include "reports/viewer/html_parts.h"
#include "reports/viewer/html_table.h"
#include "reports/words/describe.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

// An image has a channel a pixel: the rest is in the table's place, the JSON record.
constexpr std::size_t most_channels = 6;

std::vector<std::string> channel_names(const Suite& suite) {
  std::vector<std::string> names;
  for (const EstimatorSummary& estimator : suite.estimators) {
    for (const EstimatorChannel& channel : estimator.channels) {
      if (std::find(names.begin(), names.end(), channel.name) == names.end())
        names.push_back(channel.name);
    }
  }
  return names;
}

std::string confidence_of(const Suite& suite) {
  return suite.estimators.empty() ? std::string()
                                  : confidence_text(suite.estimators.front().confidence);
}

bool lacks_interval(const Estimate& estimate) {
  return estimate.value && !estimate.low && !estimate.high;
}

bool has_bare_bars(const Suite& suite) {
  for (const EstimatorSummary& estimator : suite.estimators) {
    for (const EstimatorChannel& channel : estimator.channels) {
      if (lacks_interval(channel.mean) || lacks_interval(channel.variance)) return true;
    }
  }
  return false;
}

std::string bars_legend(const Suite& suite) {
  const std::string text = fmt::format(
      "Bars from zero with {} intervals; dashed lines are exact values where known. Names in "
      "italics are mutants. Estimators share a chart where a claim names them together, where "
      "they estimate one exact value, or where one is a mutant of the other.",
      confidence_of(suite));
  if (!has_bare_bars(suite)) return text;
  return text +
         " Of an image the bars are means over its pixels; a variance has no interval there, nor a "
         "mean whose pixels depend on each other.";
}

std::string pairs_legend(const Suite& suite) {
  return fmt::format(
      "Row against column, at this suite's alpha of {} over all pairs. Above the diagonal means: = "
      "agree (no evidence of a difference), ≠ differ, with p. Below it variances: < the row's is "
      "smaller, > larger, · no evidence, with the row's variance over the column's. Where cells "
      "are too small for numbers, pointing at one shows them.",
      human(suite.alpha));
}

std::string group_names(const Suite& group) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(group.estimators.size(), 3); ++i)
    text += (i > 0 ? ", " : "") + one_line(group.estimators[i].name);
  const std::size_t rest =
      group.estimators.size() - std::min<std::size_t>(group.estimators.size(), 3);
  return rest > 0 ? fmt::format("{} and {} more", text, rest) : text;
}

std::string estimate_markup(const Estimate& estimate) {
  std::string out = "<span>" + data_text(estimate.value);
  if (estimate.value && (estimate.low || estimate.high))
    out += fmt::format("<br/><span class=\"muted whole\">[{}, {}]</span>", human(estimate.low),
                       human(estimate.high));
  return out + "</span>";
}

std::string kind_of(const EstimatorSummary& estimator) {
  if (estimator.original.empty()) return estimator.bias;
  return fmt::format("mutant of {}: {}", estimator.original, estimator.defect);
}

std::string variance_markup(const EstimatorSummary& estimator, const EstimatorChannel& channel) {
  const std::string text = estimate_markup(channel.variance);
  if (estimator.variance_of.empty() || !channel.variance.value) return text;
  return fmt::format("<span>{}<br/><span class=\"muted whole\">of one {}</span></span>", text,
                     escape_xml(one_line(estimator.variance_of)));
}

void add(HtmlTable& table, const EstimatorSummary& estimator) {
  const std::string kind = escape_xml(one_line(kind_of(estimator)));
  for (std::size_t i = 0; i < std::min(estimator.channels.size(), most_channels); ++i) {
    const EstimatorChannel& channel = estimator.channels[i];
    table.row({{source_markup(estimator.name, estimator.plugin, estimator.parameters), "name"},
               {kind},
               {escape_xml(one_line(channel.name))},
               {estimate_markup(channel.mean)},
               {variance_markup(estimator, channel)},
               {fmt::format("{} × {}", count_text(estimator.secondaries),
                            count_text(estimator.primaries))},
               cost_cell(estimator.cost)});
  }
}

std::string estimator_table(const Suite& suite) {
  if (suite.estimators.empty()) return {};
  HtmlTable table({{"estimator"},
                   {"kind"},
                   {"channel"},
                   {"mean", true},
                   {"variance", true},
                   {"observations × primaries", true},
                   {"cost, CPU time", true}},
                  "cards");
  for (const EstimatorSummary& estimator : suite.estimators) add(table, estimator);
  return fmt::format(
      "<details class=\"more\"><summary>The same in numbers, with cost</summary>\n<p "
      "class=\"muted\">Brackets are {} intervals.</p>\n{}</details>\n",
      confidence_of(suite), table.finish());
}

std::string bars(const Suite& group) {
  const std::vector<std::string> names = channel_names(group);
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), most_channels); ++i) {
    const std::string of =
        names.size() > 1 ? fmt::format("Channel {}: ", one_line(names[i])) : std::string();
    const std::string caption = of + group_names(group);
    out += "<div class=\"figures\">\n" + figure(mean_bars(group, names[i]), caption) +
           figure(variance_bars(group, names[i]), "") + "</div>\n";
  }
  if (names.size() > most_channels)
    out += fmt::format("<p>{} more channels are in the JSON record.</p>\n",
                       names.size() - most_channels);
  return out;
}

std::string pairs(const Suite& group) {
  const std::vector<std::string> names = channel_names(group);
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), most_channels); ++i) {
    std::string caption =
        names.size() > 1 ? fmt::format("Channel {}. ", one_line(names[i])) : std::string();
    if (group.estimators.size() > most_in_matrix)
      caption +=
          fmt::format("The first {} of {} estimators.", most_in_matrix, group.estimators.size());
    out += figure(pair_matrix(group, names[i]), caption);
  }
  return out;
}

std::string legend(const std::string& text) {
  return fmt::format("<p class=\"muted\">{}</p>\n", escape_xml(text));
}

}  // namespace

HtmlTable::Cell cost_cell(const Cost& cost) {
  return {.markup = fmt::format("<span>{}<br/><span class=\"muted\">{}</span></span>",
                                cost_text(cost), duration(cost.seconds)),
          .tooltip = fmt::format("{} rays, {} samples, {} s", grouped(rays(cost)),
                                 grouped(cost.samples), round_trip(cost.seconds))};
}

std::string source_markup(const std::string& name, const std::string& plugin,
                          const std::string& parameters) {
  return fmt::format("<span>{}<br/><span class=\"claim\">{} {}</span></span>",
                     escape_xml(one_line(name)), escape_xml(one_line(plugin)),
                     escape_xml(one_line(parameters_text(parameters))));
}

std::string estimator_pictures(const Suite& suite) {
  std::string all_bars, all_pairs;
  for (const Suite& group : groups(suite)) {
    all_bars += bars(group);
    all_pairs += pairs(group);
  }
  std::string out;
  if (!all_bars.empty())
    out += "<h3>The estimators side by side</h3>\n" + legend(bars_legend(suite)) + all_bars;
  out += estimator_table(suite);
  if (!all_pairs.empty())
    out +=
        "<h3>Where each pair stands at this alpha</h3>\n" + legend(pairs_legend(suite)) + all_pairs;
  return out;
}

}  // namespace assay::reports
