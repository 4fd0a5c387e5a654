#include "reports/words/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

const Channel* least_excluded(const Test& test) {
  const auto has_p = [](const Channel& each) { return each.p_pass || each.log10_p_pass; };
  if (test.channels.empty() || !std::ranges::all_of(test.channels, has_p)) return nullptr;
  // The logarithm orders p-values that underflowed too.
  return &*std::ranges::max_element(test.channels, {}, [](const Channel& each) {
    return each.log10_p_pass ? *each.log10_p_pass : std::log10(each.p_pass.value_or(0));
  });
}

NamedP p_of_claim(const Test& test) {
  const Channel channel = worst_channel(test);
  return {is_proof(test) ? "p(claim)" : "p", channel.p_value, channel.log10_p};
}

NamedP p_of_contrary(const Test& test) {
  const Channel* least = least_excluded(test);
  const char* const name = is_proof(test) ? "p(contrary)" : "p";
  return least ? NamedP{name, least->p_pass, least->log10_p_pass} : NamedP{name, {}, {}};
}

bool rests_on_contrary(const Test& test) {
  return is_proof(test) && test.verdict != Verdict::fail && least_excluded(test) != nullptr;
}

// ", corrected for 3 of 8 looks (0.79 uncorrected)".
std::string over_looks(const Test& test, Number Look::*log10_p) {
  if (test.planned_looks.size() < 2 || test.looks.empty() || test.channels.size() > 1) return {};
  const Number at_last = test.looks.back().*log10_p;
  if (!at_last) return {};
  return fmt::format(", corrected for {} of {} looks ({} uncorrected)", test.looks.size(),
                     test.planned_looks.size(), p_text({}, at_last));
}

// "welch", "forced F".
std::string method_text(const Test& test) {
  return test.forced ? "forced " + test.method : test.method;
}

// "(welch, two-sided), 1 over all claims (Holm); its share of alpha is 0.00125". Holm's number
// stands where the family changes what is written: of a single test it does not.
std::string about_the_claim(const Test& test) {
  const Channel channel = worst_channel(test);
  std::string how = method_text(test);
  if (!test.tail.empty()) how += how.empty() ? test.tail : ", " + test.tail;
  std::string text = over_looks(test, &Look::log10_p);
  if (!how.empty()) text += fmt::format(" ({})", how);
  const std::string adjusted = p_text(channel.p_adjusted, channel.log10_p_adjusted);
  if (adjusted != no_number && adjusted != p_text(channel.p_value, channel.log10_p))
    text += fmt::format(", {} over all claims (Holm)", adjusted);
  if (test.alpha) text += fmt::format("; its share of alpha is {}", human(test.alpha, 3));
  return text;
}

std::string about_the_contrary(const Test& test) {
  return test.beta ? fmt::format("; a pass needs p at most {} (beta)", human(test.beta, 3)) : "";
}

std::string image_fact(const Test& test) {
  if (!test.image) return {};
  const Image& image = *test.image;
  const std::vector<Sample>& sides = test.samples;
  const bool differ = sides.size() == 2 && sides[0].secondaries != sides[1].secondaries;
  const std::string count =
      differ ? fmt::format("{} and {} images", sides[0].secondaries, sides[1].secondaries)
             : counted(image.replicates, "image", "images");
  std::vector<std::string> parts{fmt::format("{} of {} x {} pixels{}{}", count, image.width,
                                             image.height, image.components.empty() ? "" : " of ",
                                             boost::join(image.components, ", "))};
  if (!image.winner.place.empty()) {
    const NamedP p{"p", {}, image.winner.log10_p_adjusted};
    parts.push_back(fmt::format("differs most at {}{}", image.winner.place,
                                p.exists() ? fmt::format(", {} in all", p.text()) : ""));
  }
  if (image.constant > 0) parts.push_back(fmt::format("constant elements: {}", image.constant));
  if (image.unseen > 0)
    parts.push_back(
        fmt::format("constant elements that differ: {}, rarer values may be unseen", image.unseen));
  return boost::join(parts, "; ");
}

// A margin of a ratio is a factor up or down: 20 % up is 17 % down.
std::string both_ends(const Test& test, const Effect& effect, double margin) {
  const std::string relation = sides_of(test.claim).relation;
  constexpr double small = 0.02;  // up is down but for the last digit shown
  if (!is_ratio(effect) || std::abs(margin) < small || (relation != "within" && relation != "=="))
    return {};
  const double factor = std::exp(std::abs(margin));
  return fmt::format(" (×{} to ×{})", human(1 / factor, 3), human(factor, 3));
}

std::string margins_fact(const Test& test) {
  const Effect effect = deciding_channel(test).effect;
  std::vector<std::string> parts;
  const auto add = [&](const char* words, Number margin) {
    if (margin)
      parts.push_back(fmt::format("{} {}{}", words, margin_text(*margin, effect),
                                  both_ends(test, effect, *margin)));
  };
  if (test.allow.value_or(0) != 0) add("allowed up to", test.allow);
  const bool is_within = sides_of(test.claim).relation == "within";
  add(is_within        ? "must be less than"
      : is_proof(test) ? "planned for an advantage of"
                       : "must be noticed from",
      test.detect);
  add("would be noticed from", test.detectable);
  constexpr double all = 0.9999;  // digits of what is missing to 1 say nothing of more
  const double power = test.power.value_or(0);
  if (test.power)
    parts.push_back((power > all ? "planned power above " : "planned power ") +
                    confidence_text(std::min(power, all)));
  return boost::join(parts, "; ");
}

std::string channels_fact(const Test& test) {
  if (test.channels.size() < 2) return {};
  const std::string deciding = deciding_channel(test).name;
  std::string text =
      fmt::format("{} tested, the verdict rests on {}", test.channels.size(), deciding);
  int named = 0;
  for (const Channel& channel : test.channels) {
    if (channel.name == deciding || ++named > 3) continue;
    text += fmt::format("; {} {}", channel.name, effect_text(channel.effect));
    const NamedP p{"p", channel.p_value, channel.log10_p};
    if (p.exists()) text += fmt::format(" ({})", p.text());
  }
  return text;
}

/// "violated: tail index is 0.41 (limit 0.25)"; then what is allowed for.
std::string gates_fact(const Test& test) {
  constexpr int most = 6;
  std::string text;
  int named = 0;
  for (const char* state : {"red", "amber"}) {
    const char* lead = *state == 'r' ? "violated: " : "allowed for: ";
    for (const Gate& gate : test.gates) {
      if (gate.state != state || ++named > most) continue;
      text += fmt::format("{}{}{} is {} (limit {})", text.empty() ? "" : "; ", lead, gate.name,
                          human(gate.value, 3), human(gate.limit, 3));
      lead = "";
    }
  }
  return named > most ? text + fmt::format("; {} more", named - most) : text;
}

std::string observations_fact(const Test& test) {
  constexpr std::size_t most = 12;
  std::vector<std::string> parts;
  // Channels that are counted together have samples of the same observations.
  std::set<std::tuple<std::string, std::string, std::uint64_t, std::uint64_t>> said;
  for (const Sample* sample : worst_samples(test)) {
    if (parts.size() == most) break;
    if (!said.insert({sample->estimator, sample->stream, sample->primaries, sample->nonfinite})
             .second)
      continue;
    parts.push_back(fmt::format("{} of {}", count_text(sample->secondaries), sample->estimator));
    if (sample->primaries > 1)
      parts.back() += fmt::format(" with {} each", counted(sample->primaries, "", "primaries"));
    if (sample->nonfinite > 0)
      parts.back() += fmt::format(", {} not finite", count_text(sample->nonfinite));
  }
  return boost::join(parts, "; ");
}

}  // namespace

Channel worst_channel(const Test& test) {
  return test.channels.empty() ? Channel{} : test.channels.front();
}

Channel deciding_channel(const Test& test) {
  const Channel* least = test.verdict == Verdict::fail ? nullptr : least_excluded(test);
  return least != nullptr ? *least : worst_channel(test);
}

bool is_told_by_place(const Test& test) {
  if (!test.image || test.verdict != Verdict::fail || is_proof(test)) return false;
  const ImageFinding& winner = test.image->winner;
  return !winner.place.empty() &&
         winner.log10_p_adjusted.value_or(-HUGE_VAL) <= std::log10(test.alpha.value_or(1));
}

Effect effect_in_sentence(const Test& test) {
  if (!is_evidence(test)) return {};
  if (is_told_by_place(test)) return test.image->winner.effect.value_or(Effect{});
  return deciding_channel(test).effect;
}

Sides sides_of(const std::string& claim) {
  int depth = 0;
  for (std::size_t i = 0; i < claim.size(); ++i) {
    depth += (claim[i] == '(') - (claim[i] == ')');
    if (depth != 0) continue;
    for (const std::string relation : {"==", "<=", ">=", "<", ">", " within "}) {
      if (claim.compare(i, relation.size(), relation) != 0) continue;
      Sides sides{claim.substr(0, i), relation, claim.substr(i + relation.size())};
      for (std::string* part : {&sides.left, &sides.relation, &sides.right}) boost::trim(*part);
      return sides;
    }
  }
  return {.left = claim};
}

bool is_proof(const Test& test) { return !contrary(test.claim).empty(); }

std::string contrary(const std::string& claim) {
  const auto [left, relation, right] = sides_of(claim);
  static const std::map<std::string, const char*> others{
      {"<", ">="}, {">", "<="}, {"within", "not within"}};
  const auto other = others.find(relation);
  return other == others.end() ? "" : fmt::format("{} {} {}", left, other->second, right);
}

std::string NamedP::text() const {
  const std::string value = p_text(p, log10_p);
  const bool is_bound = value.starts_with("above") || value.starts_with("below");
  return exists() ? fmt::format("{} {}{}", name, is_bound ? "" : "= ", value) : std::string();
}

NamedP headline_p(const Test& test) {
  return rests_on_contrary(test) ? p_of_contrary(test) : p_of_claim(test);
}

std::string evidence_text(const Test& test) {
  const NamedP p = headline_p(test);
  if (!p.exists()) return {};
  if (!rests_on_contrary(test)) return p.text() + about_the_claim(test);
  return p.text() + over_looks(test, &Look::log10_p_pass) +
         fmt::format(" ({})", method_text(test)) + about_the_contrary(test);
}

std::string exclusion_text(const Test& test) {
  const bool of_claim = rests_on_contrary(test);
  const NamedP p = of_claim ? p_of_claim(test) : p_of_contrary(test);
  if (!p.exists()) return {};
  if (of_claim) return p.text() + about_the_claim(test);
  const Effect effect = deciding_channel(test).effect;
  const bool of_margin = !is_proof(test) && test.detect;
  return p.text() + (of_margin ? " if the error is " + margin_text(*test.detect, effect) : "") +
         about_the_contrary(test);
}

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

std::string mark(Standing standing) {
  constexpr const char* marks[] = {"✗", "✗", "?", "✓", "✓", "–"};
  return marks[static_cast<int>(standing)];
}

std::string verdict_text(const Test& test) {
  const std::string verdict = to_string(test.verdict);
  if (test.verdict == Verdict::skipped) return verdict;
  if (test.verdict != test.expected)
    return test.expected == Verdict::pass
               ? verdict
               : fmt::format("{}, but {} expected", verdict, to_string(test.expected));
  // A verdict can be the expected one for the wrong reason; the message tells it.
  if (!test.ok) return verdict + ", yet not ok";
  return test.expected == Verdict::pass ? verdict : verdict + " (as expected)";
}

std::string key_number(const Test& test) {
  if (!is_evidence(test)) return {};
  const std::string text = named_effect_text(effect_in_sentence(test));
  return text.empty() ? headline_p(test).text() : text;
}

std::uint64_t rays(const Cost& cost) {
  return cost.camera_rays + cost.closest_hit_rays + cost.shadow_rays;
}

std::string cost_text(const Cost& cost) {
  if (rays(cost) > 0) return counted(rays(cost), "ray", "rays");
  return cost.samples > 0 ? counted(cost.samples, "sample", "samples") : std::string();
}

std::string cost_text(const Test& test) {
  const Cost cost = total_cost(test);
  if (!test.image || rays(cost) > 0) return cost_text(cost);
  std::uint64_t pictures = 0;
  for (const Sample& sample : test.samples) pictures += sample.secondaries;
  return counted(pictures, "picture", "pictures");
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

std::vector<Fact> facts(const Test& test) {
  std::vector<Fact> result;
  const auto add = [&result](const char* label, std::string sentence) {
    if (!sentence.empty()) result.push_back({label, std::move(sentence)});
  };
  const Effect effect = deciding_channel(test).effect;
  if (test.expected != Verdict::pass && test.verdict != test.expected &&
      test.verdict != Verdict::skipped)
    add("verdict", verdict_text(test));
  add("message", test.message);
  add("claim", test.claim);
  // The null hypothesis of a proof's p(claim) is the claim; what must be rejected is its contrary.
  if (is_proof(test))
    add("contrary", contrary(test.claim));
  else
    add("null hypothesis", test.null_hypothesis);
  if (is_evidence(test)) {
    if (effect.estimate) {
      const double theta = *effect.estimate;
      const std::string ln =
          is_ratio(effect) ? fmt::format(" (ln {})", with_sign(theta, false)) : "";
      add("estimate", fmt::format("{} {}{}{}", effect_name(effect), theta_text(theta, effect), ln,
                                  named_range_text(effect)));
    }
    add("evidence", evidence_text(test));
    add(is_proof(test) ? "against it" : "for a pass", exclusion_text(test));
    add("margins", margins_fact(test));
    add("channels", channels_fact(test));
    add("image", image_fact(test));
  }
  add("assumptions", gates_fact(test));
  add("observations", observations_fact(test));
  add("cost", cost_text(test));
  add("where", place(test));
  add("replay", test.no_replay);
  return result;
}

std::string plain_text(const Test& test) {
  std::string text;
  for (const auto& [label, sentence] : facts(test)) text += label + ": " + clean(sentence) + "\n";
  return test.replay.empty() ? text : text + "replay: " + clean(test.replay) + "\n";
}

std::string levels_text(const Suite& suite) {
  return fmt::format("alpha {} (false alarms), beta {} (misses), seed {}{}", human(suite.alpha),
                     human(suite.beta), suite.seed,
                     suite.timed ? ", timed (numbers do not repeat to the bit)" : "");
}

}  // namespace assay::reports
