#include "reports/describe.h"

#include <fmt/format.h>

#include <cmath>

#include "reports/number.h"
#include "reports/text.h"

namespace assay::reports {
namespace {

std::string ratio_note(const Effect& effect) {
  if (!effect.estimate || effect.quantity.rfind("ln ", 0) != 0) return {};
  return fmt::format(" (ratio {})", human(std::exp(*effect.estimate)));
}

bool bounded(const Number& end) { return end && std::isfinite(*end); }

// "[low, high]", or the one bound of a one-sided interval.
std::string interval_text(const Effect& effect) {
  const auto end = [&](const Number& value) { return with_sign(*value, effect.relative); };
  if (bounded(effect.low) && bounded(effect.high))
    return fmt::format("[{}, {}]", end(effect.low), end(effect.high));
  if (bounded(effect.low)) return fmt::format("[from {}]", end(effect.low));
  return bounded(effect.high) ? fmt::format("[to {}]", end(effect.high)) : std::string();
}

std::string estimate_fact(const Effect& effect) {
  std::string text = fmt::format("{} {}{}", effect.quantity,
                                 with_sign(*effect.estimate, effect.relative), ratio_note(effect));
  if (const std::string interval = interval_text(effect); !interval.empty())
    text += fmt::format(", {} interval {}", confidence_text(effect.confidence), interval);
  return text;
}

std::string p_fact(const Test& test, const Channel& channel) {
  std::string text = fmt::format("p = {}", p_text(channel.p_value, channel.log10_p));
  std::string how = test.method;
  if (!test.tail.empty()) how += how.empty() ? test.tail : ", " + test.tail;
  if (!how.empty()) text += fmt::format(" ({})", how);
  if (channel.p_adjusted) text += fmt::format(", {} after Holm", p_text(channel.p_adjusted, {}));
  if (test.alpha) text += fmt::format("; its share of alpha is {}", human(*test.alpha, 3));
  if (channel.p_pass)
    text += fmt::format("; p = {} of an effect that must not pass", p_text(channel.p_pass, {}));
  return text;
}

std::string margins_fact(const Test& test) {
  const bool relative = worst_channel(test).effect.relative;
  std::string text;
  const auto add = [&](const char* words, Number margin) {
    if (!margin) return;
    if (!text.empty()) text += "; ";
    text += fmt::format("{} {}", words, magnitude(*margin, relative));
  };
  if (test.allow.value_or(0) != 0) add("allowed up to", test.allow);
  add("must be noticed from", test.detect);
  add("would be noticed from", test.detectable);
  if (test.power)
    text += fmt::format("{}planned power {}", text.empty() ? "" : "; ", percent(*test.power));
  return text;
}

std::string channels_fact(const Test& test) {
  if (test.channels.size() < 2) return {};
  std::string text =
      fmt::format("{} tested, the worst is {}", test.channels.size(), test.channels.front().name);
  for (std::size_t i = 1; i < test.channels.size() && i < 4; ++i) {
    const Channel& channel = test.channels[i];
    text += fmt::format("; {} {} (p = {})", channel.name, effect_text(channel.effect),
                        p_text(channel.p_value, channel.log10_p));
  }
  return text;
}

std::string gates_fact(const Test& test) {
  std::string text;
  for (const Gate& gate : test.gates) {
    if (gate.state == "green") continue;
    if (!text.empty()) text += "; ";
    text += fmt::format("{} is {} ({}, limit {})", gate.name, gate.state, human(gate.value),
                        human(gate.limit));
  }
  return text;
}

std::string expectation_fact(const Test& test) {
  if (test.verdict == test.expected || test.verdict == Verdict::skipped) return {};
  if (test.expected == Verdict::pass) return {};
  return fmt::format("{}, but the verdict is {}", to_string(test.expected),
                     to_string(test.verdict));
}

std::string observations_fact(const Test& test) {
  std::string text;
  for (const Sample* sample : worst_samples(test)) {
    if (text.size() > 1000) break;
    if (!text.empty()) text += "; ";
    text += fmt::format("{} of {} with {} primaries each", count_text(sample->secondaries),
                        sample->estimator, count_text(sample->primaries));
    if (sample->nonfinite > 0)
      text += fmt::format(", {} not finite", count_text(sample->nonfinite));
  }
  return text;
}

}  // namespace

Channel worst_channel(const Test& test) {
  return test.channels.empty() ? Channel{} : test.channels.front();
}

std::vector<const Sample*> worst_samples(const Test& test) {
  const std::string channel = worst_channel(test).name;
  std::vector<const Sample*> of_channel, all;
  for (const Sample& sample : test.samples) {
    all.push_back(&sample);
    if (sample.channel == channel) of_channel.push_back(&sample);
  }
  return of_channel.empty() ? all : of_channel;
}

std::string effect_text(const Effect& effect) {
  if (!effect.estimate) return {};
  const std::string text = with_sign(*effect.estimate, effect.relative);
  const std::string interval = interval_text(effect);
  return interval.empty() ? text : fmt::format("{} {}", text, interval);
}

std::string key_number(const Test& test) {
  const Channel channel = worst_channel(test);
  std::string text = effect_text(channel.effect);
  if (text.empty() && (channel.p_value || channel.log10_p))
    text = "p = " + p_text(channel.p_value, channel.log10_p);
  return text;
}

std::string outcome_word(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return "ok";
    case Outcome::failed:
      return "not ok";
    case Outcome::inconclusive:
      return "undecided";
    case Outcome::skipped:
      break;
  }
  return "not run";
}

std::string mark(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return "✓";
    case Outcome::failed:
      return "✗";
    case Outcome::inconclusive:
      return "?";
    case Outcome::skipped:
      break;
  }
  return "–";
}

std::string verdict_text(const Test& test) {
  const std::string verdict = to_string(test.verdict);
  if (test.expected == Verdict::pass || test.verdict == Verdict::skipped) return verdict;
  if (test.verdict == test.expected) return verdict + " (as expected)";
  return fmt::format("{} (expected {})", verdict, to_string(test.expected));
}

std::uint64_t rays(const Cost& cost) {
  return cost.camera_rays + cost.closest_hit_rays + cost.shadow_rays;
}

std::string cost_text(const Cost& cost) {
  if (rays(cost) > 0) return count_text(rays(cost)) + " rays";
  return cost.samples > 0 ? count_text(cost.samples) + " samples" : std::string();
}

std::string place(const Test& test) {
  if (test.file.empty()) return {};
  return test.line > 0 ? fmt::format("{}:{}", test.file, test.line) : test.file;
}

std::string headline(const Test& test) {
  if (test.verdict != test.expected && test.expected != Verdict::pass)
    return fmt::format("expected {}, got {}: {}", to_string(test.expected), to_string(test.verdict),
                       test.message.empty() ? test.claim : test.message);
  if (!test.message.empty()) return test.message;
  const std::string number = key_number(test);
  return number.empty() ? to_string(test.verdict) : number;
}

std::string tally_sentence(const Tally& tally) {
  const int total = tally.passed + tally.failed + tally.inconclusive + tally.skipped;
  if (total == 0) return "No test ran";
  if (tally.failed > 0) return fmt::format("{} of {} tests not ok", tally.failed, total);
  if (tally.inconclusive > 0)
    return fmt::format("No test failed, {} of {} inconclusive", tally.inconclusive, total);
  if (tally.skipped == total) return fmt::format("All {} tests skipped", total);
  if (tally.skipped > 0)
    return fmt::format("All {} tests that ran are ok, {} skipped", tally.passed, tally.skipped);
  return total == 1 ? "The test is ok" : fmt::format("All {} tests ok", total);
}

std::vector<Fact> facts(const Test& test) {
  std::vector<Fact> result;
  const auto add = [&result](const char* label, std::string sentence) {
    if (!sentence.empty()) result.emplace_back(label, std::move(sentence));
  };
  const Channel channel = worst_channel(test);
  add("expected", expectation_fact(test));
  add("message", test.message);
  add("claim", test.claim);
  add("null hypothesis", test.null_hypothesis);
  if (channel.effect.estimate) add("estimate", estimate_fact(channel.effect));
  if (channel.p_value || channel.log10_p) add("evidence", p_fact(test, channel));
  add("margins", margins_fact(test));
  add("channels", channels_fact(test));
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
                     human(suite.beta), suite.seed, suite.timed ? ", ended by a time budget" : "");
}

}  // namespace assay::reports
