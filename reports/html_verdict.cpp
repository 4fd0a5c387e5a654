#include <fmt/format.h>

#include <algorithm>

#include "reports/charts.h"
#include "reports/describe.h"
#include "reports/html_parts.h"
#include "reports/number.h"
#include "reports/text.h"

namespace assay::reports {
namespace {

std::string definition(const std::string& label, const std::string& sentence) {
  if (sentence.empty()) return {};
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", label, escape_xml(sentence));
}

std::string definitions(const Test& test) {
  std::string out = "<dl>\n";
  for (const auto& [label, sentence] : facts(test)) out += definition(label, sentence);
  out += definition("cost", cost_text(total_cost(test)));
  out += definition("where", place(test));
  std::string tags;
  for (const std::string& tag : test.tags) tags += (tags.empty() ? "" : ", ") + one_line(tag);
  return out + definition("tags", tags) + "</dl>\n";
}

std::vector<const Sample*> drawn_samples(const Test& test) {
  std::vector<const Sample*> samples = worst_samples(test);
  if (samples.size() > 2) samples.resize(2);
  return samples;
}

std::string interval_caption(const Test& test) {
  const Effect effect = worst_channel(test).effect;
  std::string text = fmt::format("The effect with its {} interval, against zero (solid line)",
                                 confidence_text(effect.confidence));
  if (test.detect) text += ", what must be noticed (dashed, ±detect)";
  if (test.allow.value_or(0) > 0) text += ", what is allowed (shaded)";
  if (test.channels.size() > most_in_interval_chart)
    text +=
        fmt::format("; the worst {} of {} channels", most_in_interval_chart, test.channels.size());
  return text + ".";
}

std::string histogram_caption(const Test& test, const std::vector<const Sample*>& samples) {
  std::string text = "The observations";
  if (test.channels.size() > 1) text += fmt::format(" of channel {}", worst_channel(test).name);
  if (samples.size() > 1) text += ": the first filled, the second as an outline";
  return text + (worst_channel(test).reference ? "; dashed: the reference." : ".");
}

std::string pictures(const Test& test) {
  const std::vector<const Sample*> samples = drawn_samples(test);
  std::string out = "<div class=\"figures\">\n";
  out += figure(interval_chart(test), interval_caption(test));
  out += figure(histogram_chart({samples, worst_channel(test).reference}),
                histogram_caption(test, samples));
  for (const Sample* sample : samples)
    out +=
        figure(quantile_chart(*sample), "Normal quantile plot: on the dashed line where normal.");
  return out + "</div>\n";
}

// The states of a gate are the record's, but a style must be one of ours.
const char* state_style(const std::string& state) {
  if (state == "red") return "red";
  return state == "amber" ? "amber" : "green";
}

std::string gates(const Test& test) {
  if (test.gates.empty()) return {};
  std::string out =
      "<table class=\"small\"><thead><tr><th>assumption checked</th><th class=\"number\">value</th>"
      "<th class=\"number\">limit</th><th>state</th></tr></thead><tbody>\n";
  for (const Gate& gate : test.gates)
    out += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
        "class=\"{}\">{}</td></tr>\n",
        escape_xml(one_line(gate.name)), human(gate.value), human(gate.limit),
        state_style(gate.state), escape_xml(one_line(gate.state)));
  return out + "</tbody></table>\n";
}

std::string looks(const Test& test) {
  if (test.looks.empty()) return {};
  std::string out =
      "<table class=\"small\"><thead><tr><th>look</th><th class=\"number\">observations</th><th "
      "class=\"number\">p "
      "of the null hypothesis</th><th class=\"number\">p of the forbidden effect</th></tr></thead>"
      "<tbody>\n";
  for (std::size_t i = 0; i < test.looks.size(); ++i) {
    const Look& look = test.looks[i];
    out += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
        "class=\"number\">{}</td></tr>\n",
        i + 1, grouped(look.secondaries), p_text({}, look.log10_p), p_text(look.p_pass, {}));
  }
  return out + "</tbody></table>\n";
}

std::string sample_row(const Sample& s) {
  std::string out = fmt::format(
      "<tr><td class=\"name\">{}<br/><span class=\"claim\">{} {}</span></td><td>{}</td>",
      escape_xml(one_line(s.estimator)), escape_xml(one_line(s.plugin)),
      escape_xml(one_line(s.parameters)), escape_xml(one_line(s.channel)));
  const auto cell = [&out](const std::string& text) {
    out += fmt::format("<td class=\"number\">{}</td>", text);
  };
  cell(fmt::format("{} × {}", count_text(s.secondaries), count_text(s.primaries)));
  for (const Number& number : {s.mean, s.variance, s.skewness, s.kurtosis, s.minimum, s.maximum})
    cell(human(number));
  cell(count_text(s.nonzero));
  cell(count_text(s.nonfinite));
  cell(count_text(rays(s.cost)));
  cell(duration(s.cost.seconds));
  return out + "</tr>\n";
}

// An image has a sample a pixel.
constexpr std::size_t most_rows = 12;

std::string sample_table(const Test& test) {
  if (test.samples.empty()) return {};
  std::string out =
      "<div class=\"scroll\"><table class=\"wide\"><thead><tr><th>source</th><th>channel</th>"
      "<th class=\"number\">observations × primaries</th><th class=\"number\">mean</th>"
      "<th class=\"number\">variance</th><th class=\"number\">skewness</th><th "
      "class=\"number\">kurtosis</th><th class=\"number\">least</th><th "
      "class=\"number\">largest</th>"
      "<th class=\"number\">not zero</th><th class=\"number\">not finite</th>"
      "<th class=\"number\">rays</th><th class=\"number\">CPU time</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < std::min(test.samples.size(), most_rows); ++i)
    out += sample_row(test.samples[i]);
  out += "</tbody></table></div>\n";
  if (test.samples.size() > most_rows)
    out += fmt::format("<p>{} more samples are in the JSON record.</p>\n",
                       test.samples.size() - most_rows);
  return out;
}

std::string replay(const Test& test) {
  if (test.replay.empty()) return {};
  return fmt::format("<p class=\"muted\">The same numbers again:</p>\n<pre><code>{}</code></pre>\n",
                     escape_xml(one_line(test.replay)));
}

}  // namespace

std::string test_section(const Test& test, TestPlace place) {
  const Outcome result = outcome(test);
  const bool open = result == Outcome::failed || result == Outcome::inconclusive;
  std::string out = fmt::format(
      "<details class=\"test {}\" id=\"{}\"{}>\n<summary>{} <b>{}</b> <span "
      "class=\"key\">{}</span></summary>\n<div>\n",
      outcome_style(result), anchor(place), open ? " open=\"open\"" : "", badge(test),
      escape_xml(one_line(test.name)), escape_xml(key_number(test)));
  out += definitions(test) + pictures(test) + gates(test) + looks(test) + sample_table(test);
  return out + replay(test) + "</div>\n</details>\n";
}

}  // namespace assay::reports
