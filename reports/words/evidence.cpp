#include "reports/words/evidence.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "reports/words/number.h"

namespace assay::reports {
namespace {

struct Relation {
  std::size_t at = std::string::npos;
  std::string_view text;
};

// The first relation that stands outside all brackets: a source may have one in its parameters.
Relation find_relation(std::string_view claim) {
  static constexpr std::string_view relations[] = {"==", "<=", ">=", "<", ">", " within "};
  int depth = 0;
  for (std::size_t i = 0; i < claim.size(); ++i) {
    if (claim[i] == '(') ++depth;
    if (claim[i] == ')') --depth;
    if (depth != 0) continue;
    for (const std::string_view relation : relations) {
      if (claim.substr(i).starts_with(relation)) return {i, relation};
    }
  }
  return {};
}

// The logarithm orders p-values that underflowed too.
double order(const Channel& channel) {
  return channel.log10_p_pass ? *channel.log10_p_pass : std::log10(channel.p_pass.value_or(0));
}

const Channel* least_excluded(const Test& test) {
  const Channel* least = nullptr;
  for (const Channel& channel : test.channels) {
    if (!channel.p_pass && !channel.log10_p_pass) return nullptr;
    if (least == nullptr || order(channel) > order(*least)) least = &channel;
  }
  return least;
}

NamedP p_of_claim(const Test& test, const char* name) {
  const Channel channel = worst_channel(test);
  return {name, channel.p_value, channel.log10_p};
}

NamedP p_of_contrary(const Test& test, const char* name) {
  const Channel* least = least_excluded(test);
  return least ? NamedP{name, least->p_pass, least->log10_p_pass} : NamedP{name, {}, {}};
}

bool rests_on_contrary(const Test& test) {
  return is_proof(test) && test.verdict != Verdict::fail && least_excluded(test) != nullptr;
}

// " over 3 looks (0.79 at the last)".
std::string over_looks(const Test& test, Number Look::*log10_p) {
  if (test.planned_looks.size() < 2 || test.looks.empty() || test.channels.size() > 1) return {};
  const Number at_last = test.looks.back().*log10_p;
  if (!at_last) return {};
  return fmt::format(" over {} look{} ({} at the last)", test.looks.size(),
                     test.looks.size() == 1 ? "" : "s", p_text({}, at_last));
}

// ", 1 after Holm", where the family changes what is written: of a single test it does not.
std::string after_holm(const Channel& channel) {
  if (!channel.p_adjusted && !channel.log10_p_adjusted) return {};
  const std::string adjusted = p_text(channel.p_adjusted, channel.log10_p_adjusted);
  if (adjusted == p_text(channel.p_value, channel.log10_p)) return {};
  return fmt::format(", {} after Holm", adjusted);
}

// "welch", "forced F".
std::string method_text(const Test& test) {
  return test.forced ? "forced " + test.method : test.method;
}

// "(welch, two-sided), 1 after Holm; its share of alpha is 0.00125".
std::string about_the_claim(const Test& test) {
  const Channel channel = worst_channel(test);
  std::string how = method_text(test), text;
  if (!test.tail.empty()) how += how.empty() ? test.tail : ", " + test.tail;
  text += over_looks(test, &Look::log10_p);
  if (!how.empty()) text += fmt::format(" ({})", how);
  text += after_holm(channel);
  if (test.alpha) text += fmt::format("; its share of alpha is {}", human(*test.alpha, 3));
  return text;
}

std::string about_the_contrary(const Test& test) {
  return test.beta ? fmt::format("; beta is {}", human(*test.beta, 3)) : std::string();
}

}  // namespace

Channel worst_channel(const Test& test) {
  return test.channels.empty() ? Channel{} : test.channels.front();
}

Channel deciding_channel(const Test& test) {
  const Channel* least = test.verdict == Verdict::fail ? nullptr : least_excluded(test);
  return least != nullptr ? *least : worst_channel(test);
}

std::string relation_of(const std::string& claim) {
  const std::string_view text = find_relation(claim).text;
  return text == " within " ? "within" : std::string(text);
}

bool is_proof(const Test& test) {
  const std::string relation = relation_of(test.claim);
  return relation == "<" || relation == ">" || relation == "within";
}

std::string contrary(const std::string& claim) {
  const Relation found = find_relation(claim);
  const auto with = [&](const char* relation) {
    return claim.substr(0, found.at) + relation + claim.substr(found.at + found.text.size());
  };
  if (found.text == "<") return with(">=");
  if (found.text == ">") return with("<=");
  return found.text == " within " ? with(" not within ") : std::string();
}

std::string NamedP::text() const {
  return exists() ? fmt::format("{} = {}", name, p_text(p, log10_p)) : std::string();
}

NamedP headline_p(const Test& test) {
  if (rests_on_contrary(test)) return p_of_contrary(test, "p(contrary)");
  return p_of_claim(test, is_proof(test) ? "p(claim)" : "p");
}

NamedP other_p(const Test& test) {
  if (rests_on_contrary(test)) return p_of_claim(test, "p(claim)");
  return p_of_contrary(test, is_proof(test) ? "p(contrary)" : "p");
}

std::string evidence_text(const Test& test) {
  const NamedP p = headline_p(test);
  if (!p.exists()) return {};
  if (!rests_on_contrary(test)) return p.text() + about_the_claim(test);
  return p.text() + over_looks(test, &Look::log10_p_pass) +
         fmt::format(" ({})", method_text(test)) + about_the_contrary(test);
}

std::string exclusion_text(const Test& test) {
  const NamedP p = other_p(test);
  if (!p.exists()) return {};
  if (rests_on_contrary(test)) return p.text() + about_the_claim(test);
  const char* of = is_proof(test) ? "" : " of an effect that must not pass";
  return p.text() + of + about_the_contrary(test);
}

}  // namespace assay::reports
