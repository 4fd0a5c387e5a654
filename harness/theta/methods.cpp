#include "harness/theta/methods.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/sampling/prepare.h"
#include "harness/theta/theta.h"

namespace assay::harness {
namespace {

/// The null hypothesis of a strict relation is its contrary.
std::string relation_text(const TestEntry& test) {
  if (test.claim.relation == Relation::within) {
    return fmt::format("within {} of", to_string(test.claim.margin));
  }
  constexpr const char* texts[] = {"=", "<=", ">=", "<=", ">="};
  return texts[static_cast<int>(test.claim.relation)];
}

[[noreturn]] void refuse_method(const Question& question, const std::string& method,
                                const std::string& why) {
  const Location& where = question.test->place_of("test");
  // The place of an option names the method itself.
  if (where.line == 0) refuse(where, why);
  refuse(where, "`test: {}` {}", method, why);
}

void require_data(const Method& method, const Question& question) {
  const Ends wanted = method.is.in_range ? ends_that_decide(question)
                                         : Ends{method.is.of_both_ends, method.is.of_both_ends};
  for (const Subject& subject : question.subjects) {
    if (method.is.of_observations && as_recorded_run(*subject.setup) != nullptr) {
      refuse_method(question, method.name,
                    fmt::format("needs observations, and `{}` has the moments of a run",
                                subject.estimator->name));
    }
    // The ends of rows of two values are these values.
    const bool has_ends = is_recorded(subject) && method.is.of_both_ends;
    if (has_ends || !(wanted.low || wanted.high)) continue;
    for (const Channel& channel : subject.declared()) {
      if (wanted.are_finite({channel.low, channel.high})) continue;
      refuse_method(question, method.name,
                    fmt::format("needs a declared range of `{}`: {}", subject.estimator->name,
                                is_recorded(subject) ? "rows declare none, leave `test` out"
                                                     : "give its channel `low` and `high`"));
    }
  }
}

/// The rows of the families that claims about the quantities may belong to. Families that derive
/// from each other have the same ones.
std::vector<Method> rows_of_families() {
  std::vector<Method> rows;
  const auto same = [](const Method& a, const Method& b) {
    return a.name == b.name && a.summary == b.summary && a.keeps == b.keeps;
  };
  const auto add = [&](const Theta* theta) {
    if (theta == nullptr || !std::ranges::search(rows, theta->methods, same).empty()) return;
    rows.insert(rows.end(), theta->methods.begin(), theta->methods.end());
  };
  for (const QuantityRow& row : quantities()) add(row.theta);
  for (const QuantityRow& row : quantities()) add(row.slope);
  for (const QuantityRow& row : quantities()) add(row.theta->of_images());
  return rows;
}

}  // namespace

Ends ends_that_decide(const Question& question) {
  const Regions regions{.relation = question.test->claim.relation};
  const std::vector<int> sides = regions.sides();
  if (question.of_two() || sides.size() > 1 || (!regions.proof() && question.test->detect)) {
    return {};
  }
  return {.low = sides.front() > 0, .high = sides.front() < 0};
}

const std::vector<Method>& method_table() {
  static const std::vector<Method> table = rows_of_families();
  return table;
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> each;
    for (const Method& row : method_table()) {
      if (std::ranges::find(each, row.name) == each.end()) each.push_back(row.name);
    }
    return each;
  }();
  return names;
}

std::vector<Method> methods_for(const Question& question) {
  const auto answers = [&](const Method& row) { return row.answers(question); };
  return mapped(question.theta->methods | std::views::filter(answers), std::identity());
}

Method find_method(const Question& question, const std::string& name) {
  const std::vector<Method> known = methods_for(question);
  const auto found = std::ranges::find(known, name, &Method::name);
  if (found == known.end()) {
    refuse(question.test->place_of("test"), "`{}` cannot test `{}`; there is {}", name,
           question.test->claim.text, quoted(mapped(known, &Method::name)));
  }
  require_data(*found, question);
  return *found;
}

std::string null_hypothesis(const Question& question, std::size_t channel) {
  const TestEntry& test = *question.test;
  const Quantity& left = test.claim.left;
  std::string text = fmt::format("{} {} {}", to_string(left), relation_text(test),
                                 question.theta->claimed_value(question, channel));
  if (test.reference) {
    text += fmt::format(", reference mean({})", to_string(*test.reference));
  } else if (left.row->relative_to_0 && !left.slope) {
    text += fmt::format(", reference {}", question.references[channel].value);
  }
  text += question.theta->circumstances(question);
  if (left.row->counts_cost) {
    text += fmt::format(", cost in {}", cost_words[static_cast<std::size_t>(test.cost)]);
  }
  if (test.over) text += fmt::format(" over {}", test.over->parameter);
  if (question.channel_count() > 1) {
    text += fmt::format(" in channel {}", question.channel_name(channel));
  }
  if (test.allow && test.allow->value > 0) {
    text += fmt::format(", up to {}", to_string(*test.allow));
  }
  return text;
}

}  // namespace assay::harness
