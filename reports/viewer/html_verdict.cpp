#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/viewer/charts.h"
#include "reports/viewer/html_parts.h"
#include "reports/viewer/html_table.h"
#include "reports/words/describe.h"
#include "reports/words/effect.h"
#include "reports/words/evidence.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

bool needs_a_look(const Test& test) {
  const Outcome result = outcome(test);
  return result == Outcome::failed || result == Outcome::inconclusive;
}

std::string definition(const std::string& label, const std::string& sentence) {
  if (sentence.empty()) return {};
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", label, escape_xml(sentence));
}

std::string definitions(const Test& test) {
  std::string out = "<dl>\n";
  // The summary above has the message of what is not ok.
  for (const auto& [label, sentence] : facts(test)) {
    if (label != "message" || !needs_a_look(test)) out += definition(label, sentence);
  }
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
  const Effect effect = deciding_channel(test).effect;
  const std::string interval = interval_name(effect);
  std::string text = interval.empty() ? "The effect" : "The effect with its " + interval;
  text +=
      is_ratio(effect) ? ", against a ratio of one (solid line)" : ", against zero (solid line)";
  if (test.detect)
    text += is_proof(test) ? ", the margin of the claim (dashed)"
                           : ", what must be noticed (dashed, detect)";
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

std::string law_caption(const Test& test) {
  const std::vector<EmpiricalLaw>& laws = worst_channel(test).laws;
  if (laws.empty()) return {};
  const std::string confidence = confidence_text(laws[0].confidence);
  if (laws.size() > 1) {
    return fmt::format(
        "Both empirical distribution functions. Each band holds the law of its sample everywhere "
        "with probability {}.",
        confidence);
  }
  return fmt::format(
      "The empirical distribution function. The band holds the law of the sample everywhere with "
      "probability {}; dashed: the law claimed.",
      confidence);
}

std::string pictures(const Test& test) {
  const std::vector<const Sample*> samples = drawn_samples(test);
  std::string out;
  // The chart is as wide as the page; beside it the others would stand one by one.
  if (is_evidence(test)) out += figure(interval_chart(test), interval_caption(test));
  out += "<div class=\"figures\">\n";
  out += figure(histogram_chart({samples, worst_channel(test).reference}),
                histogram_caption(test, samples));
  out += figure(law_chart(worst_channel(test)), law_caption(test));
  // A claim about a law is not about normality.
  for (const Sample* sample : samples) {
    if (!worst_channel(test).laws.empty()) break;
    out +=
        figure(quantile_chart(*sample), "Normal quantile plot: on the dashed line where normal.");
  }
  return out + "</div>\n";
}

// The states of a gate are the record's, but a style must be one of ours.
const char* state_style(const std::string& state) {
  if (state == "red") return "red";
  return state == "amber" ? "amber" : "green";
}

// The gates of an invalid test may all be green: those on its pilot, where its plan was refused.
bool is_red_elsewhere(const Test& test) {
  return test.verdict == Verdict::invalid &&
         std::none_of(test.gates.begin(), test.gates.end(),
                      [](const Gate& gate) { return gate.state == "red"; });
}

std::string gates(const Test& test) {
  if (test.gates.empty() && !is_red_elsewhere(test)) return {};
  HtmlTable table({{"assumption checked"}, {"value", true}, {"limit", true}, {"state"}},
                  "small cards");
  if (is_red_elsewhere(test))
    table.row({{"what the message says"}, {""}, {""}, {"red", state_style("red")}});
  for (const Gate& gate : test.gates)
    table.row({{escape_xml(one_line(gate.name))},
               {human(gate.value)},
               {human(gate.limit)},
               {escape_xml(one_line(gate.state)), state_style(gate.state)}});
  return table.finish();
}

std::string looks(const Test& test) {
  if (test.looks.empty() || !is_evidence(test)) return {};
  HtmlTable table(
      {{"look", true},
       {"observations", true},
       {"level", true},
       {"p of the claim", true},
       {is_proof(test) ? "p of the contrary" : "p of an effect that must not pass", true}},
      "small cards");
  for (std::size_t i = 0; i < test.looks.size(); ++i) {
    const Look& look = test.looks[i];
    table.row({{fmt::format("{}", i + 1)},
               {grouped(look.secondaries)},
               {human(look.alpha)},
               {p_text({}, look.log10_p)},
               {p_text(look.p_pass, look.log10_p_pass)}});
  }
  return table.finish();
}

bool has_data(const Sample& sample) {
  return (sample.mean && !std::isnan(*sample.mean)) || sample.nonfinite < sample.secondaries;
}

void add(HtmlTable& table, const Sample& s) {
  const auto number = [&](const Number& value) {
    return has_data(s) ? human(value) : data_text(std::nullopt);
  };
  table.row({{source_markup(s.estimator, s.plugin, s.parameters), "name"},
             {escape_xml(one_line(s.channel))},
             {fmt::format("{} × {}", count_text(s.secondaries), count_text(s.primaries))},
             {number(s.mean)},
             {number(s.variance)},
             {fmt::format("<span>{} /<br/>{}</span>", number(s.skewness), number(s.kurtosis))},
             {fmt::format("<span>{} …<br/>{}</span>", number(s.minimum), number(s.maximum))},
             {fmt::format("{} / {}", count_text(s.nonzero), count_text(s.nonfinite))},
             cost_cell(s.cost)});
}

constexpr std::size_t most_rows = 12;

std::string sample_table(const Test& test) {
  if (test.samples.empty()) return {};
  HtmlTable table({{"source"},
                   {"channel"},
                   {"observations × primaries", true},
                   {"mean", true},
                   {"variance of an observation", true},
                   {"skewness / kurtosis", true},
                   {"least … largest", true},
                   {"not zero / not finite", true},
                   {"cost, CPU time", true}},
                  "wide cards");
  for (std::size_t i = 0; i < std::min(test.samples.size(), most_rows); ++i)
    add(table, test.samples[i]);
  std::string out = table.finish();
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
  const bool open = needs_a_look(test);
  // Folded, a row that is not ok still says why; the reason has the numbers in it.
  const std::string key = open ? one_line(headline(test)) : key_number(test);
  std::string out = fmt::format(
      "<details class=\"test {}\" id=\"{}\"{}>\n<summary>{} <b>{}</b> <span "
      "class=\"key\">{}</span></summary>\n<div>\n",
      outcome_style(result), anchor(place), open ? " open=\"open\"" : "", badge(test),
      escape_xml(one_line(test.name)), escape_xml(key));
  out += definitions(test) + image_section(test) + cells_section(test) + pictures(test) +
         gates(test) + looks(test) + sample_table(test);
  return out + replay(test) + "</div>\n</details>\n";
}

}  // namespace assay::reports
