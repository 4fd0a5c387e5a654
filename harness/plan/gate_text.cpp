#include "harness/plan/gate_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "harness/plan/rows.h"
#include "reports/words/number.h"

namespace assay::harness {
namespace {

/// Sentence for a red gate; {0} is its value, {1} its limit.
struct Meaning {
  const char* gate;
  const char* text;
};

constexpr Meaning meanings[] = {
    {"count",
     "{0} rows are too few to show how skewed they are: at this level it takes {1}; give more"},
    {"skewness of the mean", "the rows are too few for how skewed they are"},
    {"level factor by skewness",
     "the observations are so skewed that one tail of the test is off by a factor of {0}, limit "
     "{1}"},
    {"level factor of the mean cost",
     "the costs are so skewed that one tail of the test is off by a factor of {0}, limit {1}"},
    {"level factor of the mean variance",
     "the variances of groups of observations are so skewed that one tail of the test is off by a "
     "factor of {0}, limit {1}"},
    {"level factor after correction",
     "the observations are so skewed that one tail of the test is off by a factor of {0} even "
     "after correction, limit {1}"},
    {"largest deviation",
     "one observation outweighs the others: its deviation over standard deviation and sqrt(n) is "
     "{0}, limit {1}"},
    {"excess kurtosis",
     "the observations are not normal enough for this test of their variance: their excess "
     "kurtosis is {0}, limit {1}"},
    {"p of a power law",
     "the points lie on no power law: p {0} of the best one, limit {1}; let `over` begin where one "
     "holds, often at larger values"},
    {"skewness of the images, theirs alone",
     "rare bright pixels (fireflies), of which the pilot saw too few, move the tails of the test "
     "by a factor of {0} at least, limit {1}; take more samples a picture"},
    {"rounding",
     "the values are rounded too coarsely to be held against a continuous law: a step is {0} of "
     "the distance that is rejected, limit {1}; write more digits"},
};

std::string short_number(reports::Number value) {
  if (!value) return "not a number";
  return std::abs(*value) >= 1000 ? reports::human(*value, 3) : fmt::format("{:.3g}", *value);
}

std::string sentence(const reports::Gate& gate) {
  const std::string value = short_number(gate.value);
  const std::string limit = short_number(gate.limit);
  for (const Meaning& meaning : meanings) {
    const std::string_view name = meaning.gate;
    if (!gate.name.starts_with(name)) continue;
    // The rest of the name is a channel or an estimator.
    return fmt::format(fmt::runtime(meaning.text), value, limit) +
           (gate.name.size() > name.size() ? " (" + gate.name + ")" : "");
  }
  return fmt::format("{} is {}, limit {}", gate.name, value, limit);
}

bool is_red(const reports::Gate& gate, std::string_view name) {
  return gate.state == "red" && gate.name.starts_with(name);
}

/// A claim that does not rest on moments.
std::string median_of(const Question& question) {
  return fmt::format("quantile({}, 0.5) == …", to_string(question.test->claim.left.source));
}

/// Factor on the observations that would turn the gate green.
double wanted(const reports::Gate& gate) {
  if (!gate.value || !gate.limit) return 1;
  // The level factor's logarithm falls like 1 / sqrt(n); it is green at a quarter.
  if (is_red(gate, "level factor by skewness") || is_red(gate, "level factor of the mean ")) {
    return std::pow(std::log(*gate.value) / std::log(1.25), 2);
  }
  if (is_red(gate, "skewness of the mean")) return std::pow(*gate.value / *gate.limit, 2);
  return 1;
}

}  // namespace

std::string red_gates(const std::vector<reports::Gate>& gates) {
  // Nothing else is worth saying of too few rows.
  for (const char* name : {"count", "skewness of the mean"}) {
    for (const reports::Gate& gate : gates) {
      if (is_red(gate, name)) return sentence(gate);
    }
  }
  std::string text;
  constexpr int most = 4;
  int red = 0;
  for (const reports::Gate& gate : gates) {
    if (gate.state != "red" || ++red > most) continue;
    text += (text.empty() ? "" : "; ") + sentence(gate);
  }
  if (red > most) text += fmt::format("; {} gates are red in all", red);
  return text;
}

std::string in_words(const std::exception& error) {
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  const std::string_view name = std::string_view(text).substr(0, colon);
  const bool is_name =
      colon != std::string::npos && name.find_first_not_of(
                                        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789_:") == std::string_view::npos;
  if (!is_name) return text;
  return "there is no test of these numbers: " + text.substr(colon + 2);
}

std::string sizes_text(const TestOutcome& outcome, double factor) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < outcome.question.compared(); ++i) {
    texts.push_back(reports::human(factor * static_cast<double>(outcome.secondaries(i)), 2));
  }
  if (std::ranges::adjacent_find(texts, std::ranges::not_equal_to()) == texts.end()) {
    return texts.front();
  }
  return fmt::format("{}", fmt::join(texts, " and "));
}

std::string what_would_help(const TestOutcome& outcome) {
  bool says_it_all = true;
  bool heavy = false;
  double factor = 1;
  for (const reports::Gate& gate : outcome.gates) {
    if (is_red(gate, "count")) {
      return ", or, if they are near normal, add " +
             written_key(*outcome.question.test, "test", "t");
    }
    if (gate.state != "red") continue;
    says_it_all = says_it_all && (gate.name == "rounding" || gate.name == "p of a power law");
    heavy = heavy || is_red(gate, "excess kurtosis") || is_red(gate, "largest deviation");
    factor = std::max(factor, wanted(gate));
  }
  if (says_it_all) return "";
  const bool rows = has_rows(outcome.question);
  // If the tail's moment does not exist, more observations only make the gate redder.
  if (heavy) {
    return fmt::format(
        "; the values are heavy-tailed, and more of them may only show more of the tail: {}claim "
        "a quantile, as `{}`",
        rows ? "" : "clamp the estimator or take another, declare its range, or ",
        median_of(outcome.question));
  }
  const std::string more =
      factor > 1 && std::isfinite(factor) ? "about " + sizes_text(outcome, factor) : "more";
  if (rows) return fmt::format(": give {} rows, or rows that each average several", more);
  return fmt::format("; {} `secondaries` would help, or a larger `primaries`", more);
}

}  // namespace assay::harness
