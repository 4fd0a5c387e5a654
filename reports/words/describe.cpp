#include "reports/words/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include "reports/words/effect.h"
#include "reports/words/evidence.h"
#include "reports/words/image_text.h"
#include "reports/words/number.h"
#include "reports/words/summary.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string estimate_fact(const Effect& effect) {
  std::string text =
      fmt::format("{} {}", effect_name(effect), theta_text(*effect.estimate, effect));
  if (is_ratio(effect)) text += fmt::format(" (ln {})", with_sign(*effect.estimate, false));
  if (const std::string interval = interval_text(effect); !interval.empty())
    text += fmt::format(", {} {}", interval_name(effect), interval);
  return text;
}

// The meaning of `detect` depends on the claim.
const char* detect_words(const Test& test) {
  const std::string relation = relation_of(test.claim);
  if (relation == "within") return "must be less than";
  return is_proof(test) ? "planned for an advantage of" : "must be noticed from";
}

// A margin of a ratio is a factor up or down: 20 % up is 17 % down.
std::string both_ends(const Test& test, const Effect& effect, double margin) {
  const std::string relation = relation_of(test.claim);
  constexpr double small = 0.02;  // up is down but for the last digit shown
  if (!is_ratio(effect) || std::abs(margin) < small || (relation != "within" && relation != "=="))
    return {};
  const double factor = std::exp(std::abs(margin));
  return fmt::format(" (×{} to ×{})", human(1 / factor, 3), human(factor, 3));
}

/// Digits of what is missing to 1 say nothing of a power beyond these.
std::string power_text(double power) {
  constexpr double all = 0.9999;
  return power > all ? "above " + confidence_text(all) : confidence_text(power);
}

std::string margins_fact(const Test& test) {
  const Effect effect = deciding_channel(test).effect;
  std::string text;
  const auto add = [&](const char* words, Number margin) {
    if (!margin) return;
    if (!text.empty()) text += "; ";
    text += fmt::format("{} {}{}", words, margin_text(*margin, effect),
                        both_ends(test, effect, *margin));
  };
  if (test.allow.value_or(0) != 0) add("allowed up to", test.allow);
  add(detect_words(test), test.detect);
  add("would be noticed from", test.detectable);
  if (!test.power) return text;
  return text +
         fmt::format("{}planned power {}", text.empty() ? "" : "; ", power_text(*test.power));
}

std::string channels_fact(const Test& test) {
  if (test.channels.size() < 2) return {};
  const std::string deciding = deciding_channel(test).name;
  std::string text =
      fmt::format("{} tested, the verdict rests on {}", test.channels.size(), deciding);
  int named = 0;
  for (const Channel& channel : test.channels) {
    if (channel.name == deciding || ++named > 3) continue;
    text += fmt::format("; {} {} (p = {})", channel.name, effect_text(channel.effect),
                        p_text(channel.p_value, channel.log10_p));
  }
  return text;
}

std::string gates_fact(const Test& test) {
  constexpr int most = 6;
  std::string text;
  int named = 0;
  for (const Gate& gate : test.gates) {
    if (gate.state == "green" || ++named > most) continue;
    if (!text.empty()) text += "; ";
    text += fmt::format("{} is {} ({}, limit {})", gate.name, gate.state, human(gate.value),
                        human(gate.limit));
  }
  if (named > most) text += fmt::format("; {} more are not green", named - most);
  return text;
}

std::string expectation_fact(const Test& test) {
  if (test.verdict == test.expected || test.verdict == Verdict::skipped) return {};
  if (test.expected == Verdict::pass) return {};
  return fmt::format("{}, but the verdict is {}", to_string(test.expected),
                     to_string(test.verdict));
}

// How a character changes the depth of brackets.
int nesting(char c) { return (c == '{' || c == '[') - (c == '}' || c == ']'); }

std::string observations_fact(const Test& test) {
  std::string text;
  // Channels that are counted together have samples of the same observations.
  std::set<std::tuple<std::string, std::string, std::uint64_t, std::uint64_t>> said;
  for (const Sample* sample : worst_samples(test)) {
    if (text.size() > 1000) break;
    if (!said.insert({sample->estimator, sample->stream, sample->primaries, sample->nonfinite})
             .second) {
      continue;
    }
    if (!text.empty()) text += "; ";
    text += fmt::format("{} of {} with {} each", count_text(sample->secondaries), sample->estimator,
                        counted(sample->primaries, "primary", "primaries"));
    if (sample->nonfinite > 0)
      text += fmt::format(", {} not finite", count_text(sample->nonfinite));
  }
  return text;
}

}  // namespace

std::vector<const Sample*> worst_samples(const Test& test) {
  const std::string channel = worst_channel(test).name;
  std::set<std::string> of_channel;
  for (const Sample& sample : test.samples) {
    if (sample.channel == channel) of_channel.insert(sample.estimator);
  }
  std::vector<const Sample*> samples;
  for (const Sample& sample : test.samples) {
    // The other side's channel may have another name.
    if (sample.channel == channel || !of_channel.contains(sample.estimator)) {
      samples.push_back(&sample);
    }
  }
  return samples;
}

bool is_evidence(const Test& test) {
  return test.verdict != Verdict::invalid && test.verdict != Verdict::error;
}

std::string key_number(const Test& test) {
  if (!is_evidence(test)) return {};
  const std::string text = named_effect_text(deciding_channel(test).effect);
  return text.empty() ? headline_p(test).text() : text;
}

std::uint64_t rays(const Cost& cost) {
  return cost.camera_rays + cost.closest_hit_rays + cost.shadow_rays;
}

std::string cost_text(const Cost& cost) {
  if (rays(cost) > 0) return counted(rays(cost), "ray", "rays");
  return cost.samples > 0 ? counted(cost.samples, "sample", "samples") : std::string();
}

std::string cost_text(std::vector<Cost> costs) {
  const auto traced =
      std::partition(costs.begin(), costs.end(), [](const Cost& cost) { return rays(cost) == 0; });
  const std::string with = cost_text(total_cost({traced, costs.end()}));
  const std::string without = cost_text(total_cost({costs.begin(), traced}));
  if (with.empty() || without.empty()) return with + without;
  return fmt::format("{} and {} without rays", with, without);
}

std::string place(const Test& test) {
  if (test.file.empty()) return {};
  return test.line > 0 ? fmt::format("{}:{}", test.file, test.line) : test.file;
}

std::string headline(const Test& test) {
  if (test.verdict != test.expected && test.expected != Verdict::pass)
    return verdict_text(test) + ": " + (test.message.empty() ? test.claim : test.message);
  if (!test.message.empty()) return test.message;
  const std::string number = key_number(test);
  return number.empty() ? to_string(test.verdict) : number;
}

std::string parameters_text(const std::string& canonical) {
  std::string text;
  int depth = 0;
  for (std::size_t i = 0; i < canonical.size(); ++i) {
    if (canonical[i] != '"') {
      depth += nesting(canonical[i]);
      text += canonical[i];
      // A place to break the line between two parameters.
      if (canonical[i] == ',' && depth == 0) text += ' ';
      continue;
    }
    // A text's canonical form begins with a colon, which tells it from a number.
    const bool opens =
        i == 0 || std::string_view("=:,[{").find(canonical[i - 1]) != std::string_view::npos;
    if (opens && i + 1 < canonical.size() && canonical[i + 1] == ':') ++i;
  }
  return text;
}

std::string data_text(const Number& value) {
  return value && !std::isnan(*value) ? human(*value) : "none";
}

std::vector<Fact> facts(const Test& test) {
  std::vector<Fact> result;
  const auto add = [&result](const char* label, std::string sentence) {
    if (!sentence.empty()) result.push_back({label, std::move(sentence)});
  };
  const Channel channel = deciding_channel(test);
  add("expected", expectation_fact(test));
  add("message", test.message);
  add("claim", test.claim);
  // The null hypothesis of a proof's p(claim) is the claim; what must be rejected is its contrary.
  if (is_proof(test))
    add("contrary", contrary(test.claim));
  else
    add("null hypothesis", test.null_hypothesis);
  if (is_evidence(test)) {
    if (channel.effect.estimate) add("estimate", estimate_fact(channel.effect));
    add("evidence", evidence_text(test));
    add(is_proof(test) ? "beside it" : "passing", exclusion_text(test));
    add("margins", margins_fact(test));
    add("channels", channels_fact(test));
    add("image", image_fact(test));
  }
  add("assumptions", gates_fact(test));
  add("observations", observations_fact(test));
  return result;
}

std::string plain_text(const Test& test) {
  std::string text;
  const auto add = [&text](const std::string& label, const std::string& sentence) {
    if (!sentence.empty()) text += label + ": " + clean(sentence) + "\n";
  };
  for (const auto& [label, sentence] : facts(test)) add(label, sentence);
  add("cost", cost_text(total_cost(test)));
  add("where", place(test));
  add("replay", test.replay);
  return text;
}

std::string levels_text(const Suite& suite) {
  return fmt::format("alpha {} (false alarms), beta {} (misses), seed {}{}", human(suite.alpha),
                     human(suite.beta), suite.seed,
                     suite.timed ? ", timed (numbers do not repeat to the bit)" : "");
}

}  // namespace assay::reports
