#include <fmt/format.h>

#include <algorithm>

#include "reports/charts.h"
#include "reports/describe.h"
#include "reports/html_parts.h"
#include "reports/number.h"
#include "reports/text.h"

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

std::string bars_caption(const Suite& suite) {
  return fmt::format(
      "Red bars: mean. Blue bars: variance of one primary estimate (of a secondary one where an "
      "estimator does not average). Whiskers: {} intervals. Dashed lines: exact values where "
      "known. "
      "Names in italics are mutants.",
      confidence_of(suite));
}

std::string pairs_caption(const Suite& suite) {
  std::string text = fmt::format(
      "Row against column, at this suite's alpha of {} over all pairs. Above the diagonal means: "
      "= agree (no evidence of a difference), ≠ differ. Below it variances: < the row's is "
      "smaller, "
      "> larger, · no evidence; the number is the row's variance over the column's.",
      human(suite.alpha));
  if (suite.estimators.size() > most_in_matrix)
    text += fmt::format(" The first {} of {} estimators.", most_in_matrix, suite.estimators.size());
  return text;
}

std::string estimate_cells(const Estimate& estimate) {
  return fmt::format("<td class=\"number\">{}</td><td class=\"number\">[{}, {}]</td>",
                     human(estimate.value), human(estimate.low), human(estimate.high));
}

std::string estimator_rows(const EstimatorSummary& estimator) {
  std::string out;
  const std::string kind =
      estimator.original.empty()
          ? estimator.bias
          : fmt::format("mutant of {}: {}", estimator.original, estimator.defect);
  for (std::size_t i = 0; i < std::min(estimator.channels.size(), most_channels); ++i) {
    const EstimatorChannel& channel = estimator.channels[i];
    out += fmt::format(
        "<tr><td class=\"name\">{}<br/><span class=\"claim\">{} "
        "{}</span></td><td>{}</td><td>{}</td>",
        escape_xml(one_line(estimator.name)), escape_xml(one_line(estimator.plugin)),
        escape_xml(one_line(estimator.parameters)), escape_xml(one_line(kind)),
        escape_xml(one_line(channel.name)));
    out += estimate_cells(channel.mean) + estimate_cells(channel.variance);
    out += fmt::format(
        "<td class=\"number\">{} × {}</td><td class=\"number\">{}</td><td "
        "class=\"number\">{}</td></tr>\n",
        count_text(estimator.secondaries), count_text(estimator.primaries),
        count_text(rays(estimator.cost)), duration(estimator.cost.seconds));
  }
  return out;
}

std::string estimator_table(const Suite& suite) {
  if (suite.estimators.empty()) return {};
  std::string out =
      "<details class=\"more\"><summary>The same in numbers, with cost</summary>\n"
      "<div class=\"scroll\"><table><thead><tr><th>estimator</th><th>kind</th><th>channel</th>"
      "<th class=\"number\">mean</th><th class=\"number\">interval</th><th "
      "class=\"number\">variance</th>"
      "<th class=\"number\">interval</th><th class=\"number\">observations × primaries</th>"
      "<th class=\"number\">rays</th><th class=\"number\">CPU time</th></tr></thead>\n<tbody>\n";
  for (const EstimatorSummary& estimator : suite.estimators) out += estimator_rows(estimator);
  return out + "</tbody></table></div></details>\n";
}

std::string of_channel(const std::vector<std::string>& names, const std::string& name) {
  return names.size() > 1 ? fmt::format("Channel {}. ", one_line(name)) : std::string();
}

std::string pictures(const Suite& suite) {
  const std::vector<std::string> names = channel_names(suite);
  const std::size_t shown = std::min(names.size(), most_channels);
  std::string bars, pairs;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string channel = of_channel(names, names[i]);
    bars += figure(estimator_bars(suite, names[i]), channel + bars_caption(suite));
    pairs += figure(pair_matrix(suite, names[i]), channel + pairs_caption(suite));
  }
  std::string out;
  if (!bars.empty()) out += "<h3>The estimators side by side</h3>\n" + bars;
  if (shown < names.size())
    out += fmt::format("<p>{} more channels are in the JSON record.</p>\n", names.size() - shown);
  out += estimator_table(suite);
  if (!pairs.empty()) out += "<h3>Where each pair stands at this alpha</h3>\n" + pairs;
  return out;
}

}  // namespace

std::string suite_section(const Record& record, std::size_t index) {
  const Suite& suite = record.suites[index];
  std::string out =
      fmt::format("<h2 id=\"s{}\">{}</h2>\n", index, escape_xml(one_line(suite.name)));
  if (!suite.about.empty()) out += fmt::format("<p>{}</p>\n", escape_xml(suite.about));
  out += fmt::format("<div class=\"facts\"><span>{}</span><span>{}</span><span>{}</span></div>\n",
                     escape_xml(one_line(suite.file)), escape_xml(levels_text(suite)),
                     tally_sentence(tally(suite)));
  out += pictures(suite);
  if (!suite.tests.empty()) out += "<h3>Tests</h3>\n";
  for (std::size_t t = 0; t < suite.tests.size(); ++t)
    out += test_section(suite.tests[t], {index, t});
  return out;
}

}  // namespace assay::reports
