#include "harness/plan/outcome.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>

#include "harness/theta/ask.h"
#include "reports/words/number.h"
#include "stats/gates/assumption_gates.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

std::string short_number(reports::Number value) {
  if (!value) return "not a number";
  return std::abs(*value) >= 1000 ? reports::human(*value, 3) : fmt::format("{:.3g}", *value);
}

/// The budget that more observations need; none if the test's own number of them is the limit.
std::optional<Budget> budget_of(const TestOutcome& outcome) {
  const TestEntry& test = *outcome.question.test;
  return outcome.secondaries() == test.secondaries ? std::nullopt : test.budget;
}

/// The setting for so many times the observations.
reports::Advice setting(const TestOutcome& outcome, double factor) {
  const std::optional<Budget> budget = budget_of(outcome);
  // A budget that allowed all looks did not end them.
  const bool took_all = outcome.look + 1 >= outcome.plan.looks.count();
  if (budget && budget->seconds && !took_all) {
    return {.key = "budget",
            .value = fmt::format("{}s", std::ceil(10 * factor * *budget->seconds) / 10)};
  }
  const bool in_primaries = budget && budget->primaries;
  const std::uint64_t secondaries = outcome.secondaries();
  // The pilots of a small budget have more than their part.
  const double now = in_primaries
                         ? std::max(static_cast<double>(primaries_of_look(outcome, secondaries)) /
                                        (1 - pilots_part),
                                    static_cast<double>(*budget->primaries))
                         : static_cast<double>(secondaries);
  const double step = std::pow(10, std::max(0.0, std::floor(std::log10(factor * now)) - 1));
  return {.key = in_primaries ? "budget" : "secondaries",
          .value = fmt::format("{:.0f}", std::ceil(factor * now / step) * step)};
}

/// Chi-square and F take flatter data for normal ones and find as little as in those.
double deviation_for(const Method& method, double deviation) {
  return method.is.of_normal_values && deviation > 0 ? std::max(std::numbers::sqrt2, deviation)
                                                     : deviation;
}

/// The plan for subjects of equal sizes.
stats::MeanPlan mean_plan(const Method& method, const stats::ErrorRates& rates,
                          const PlannedChannel& channel, int side) {
  const int corrected = method.is.corrects_skewness ? side : 0;
  return {.standard_deviation = deviation_for(method, channel.deviations[0]),
          .other_standard_deviation = deviation_for(method, channel.deviations[1]),
          .skewness = corrected * channel.skewness[0],
          .other_skewness = corrected * channel.skewness[1],
          .allow = channel.regions.allow * channel.unit,
          .reference_standard_error = channel.reference_error,
          .rates = rates};
}

}  // namespace

std::string gate_sentence(const Gate& gate) {
  constexpr double most_useful_factor = 100;
  const GateKind& row = gate.row();
  const bool is_useless = row.falls == Falls::by_its_logarithm && gate.value > most_useful_factor;
  const std::string value =
      is_useless ? fmt::format("over {:g}", most_useful_factor) : short_number(gate.value);
  const std::string limit = short_number(gate.limit);
  if (row.sentence.empty()) return fmt::format("{} is {}, limit {}", gate.name, value, limit);
  // The rest of the name is a channel or an estimator.
  return fmt::format(fmt::runtime(row.sentence), value, limit) +
         (gate.name.size() > row.name.size() ? " (" + gate.name + ")" : "");
}

std::string red_gates(const std::vector<Gate>& gates) {
  std::string text;
  constexpr int most = 4;
  int red = 0;
  for (const Gate& gate : gates) {
    if (!gate.is_red() || ++red > most) continue;
    text += (text.empty() ? "" : "; ") + gate_sentence(gate);
  }
  if (red > most) text += fmt::format("; {} gates are red in all", red);
  return text;
}

std::string in_words(const std::exception& error) {
  static const std::regex function("^[a-zA-Z0-9_:]*: ");
  return std::regex_replace(
      std::string(error.what()), function,
      "there is no test of these numbers: ", std::regex_constants::format_first_only);
}

const char* rows_noun(const Question& question) {
  const bool pictures = std::ranges::any_of(
      question.subjects, [](const Subject& side) { return side.setup->pictures() != nullptr; });
  return pictures ? "pictures" : "rows";
}

std::string sizes_text(const TestOutcome& outcome, double factor) {
  const auto texts = mapped_indices(outcome.question.compared(), [&](std::size_t i) {
    return reports::human(factor * static_cast<double>(outcome.secondaries(i)), 2);
  });
  if (std::ranges::adjacent_find(texts, std::ranges::not_equal_to()) == texts.end()) {
    return texts.front();
  }
  return fmt::format("{}", fmt::join(texts, " and "));
}

Reason more_drawn(const TestOutcome& outcome, double factor, const std::string& does) {
  if (const auto budget = budget_of(outcome); budget && budget->of_suite) {
    return Reason::advising("", fmt::format("give the suite {} times its `budget`",
                                            reports::human(std::ceil(10 * factor) / 10, 2)));
  }
  const reports::Advice next = setting(outcome, factor);
  const bool many = next.key == "secondaries" && primaries_of_look(outcome, 1) > 1;
  const auto primaries = static_cast<double>(primaries_of_look(outcome, outcome.secondaries()));
  return {
      fmt::format("{}{} {}", written_key(*outcome.question.test, next.key, next.value),
                  many ? fmt::format(" ({} primaries)", reports::human(factor * primaries, 2)) : "",
                  does),
      next};
}

Reason what_would_help(const TestOutcome& outcome) {
  bool says_it_all = true;
  bool heavy = false;
  double factor = 1;
  for (const Gate& gate : outcome.gates) {
    if (!gate.is_red()) continue;
    says_it_all = says_it_all && gate.row().says_what_helps;
    heavy = heavy || gate.shows_heavy_tail(static_cast<double>(outcome.secondaries()));
    factor = std::max(factor, gate.wanted_factor());
  }
  if (says_it_all) return {};
  const Question& question = outcome.question;
  const bool rows = has_rows(question);
  // An average has another variance than what it averages.
  const bool averages = rows && !question.is().of_spread;
  // If the tail's moment does not exist, more observations only make the gate redder.
  const std::uint64_t primaries = primaries_of_look(outcome, outcome.secondaries());
  if (heavy || (factor > most_wanted && (rows || primaries > floor_of_evidence))) {
    const std::string quantile = question.subjects[0].image
                                     ? "claim the mean"
                                     : fmt::format("claim a quantile, as `quantile({}, 0.5) == …`",
                                                   to_string(question.test->claim.left.source));
    return Reason::advising(
        "; the values are heavy-tailed, and more observations may only show more of the tail: ",
        fmt::format("{}{}",
                    averages
                        ? fmt::format("give {} that each average many, or ", rows_noun(question))
                    : rows ? ""
                           : "clamp the estimator or take another, declare its range, or ",
                    quantile));
  }
  const bool known = factor > 1;
  factor = std::min(factor, most_wanted);
  if (rows) {
    const auto methods = methods_for(question);
    const auto exact = std::ranges::find_if(
        methods, [](const Method& method) { return method.is.of_normal_values; });
    const std::string noun = rows_noun(question);
    std::string instead;
    if (averages) {
      instead = fmt::format(", or {} that each average several", noun);
    } else if (exact != methods.end()) {
      instead = fmt::format(", or, of near normal values, {}",
                            written_key(*question.test, "test", exact->name));
    }
    return Reason::advising(
        ": ", fmt::format("give {} {}{}", known ? "about " + sizes_text(outcome, factor) : "more",
                          noun, instead));
  }
  Reason help = known ? more_drawn(outcome, factor, "may do") : Reason("more observations may do");
  help.text = fmt::format(
      "; {}. Without a declared range a test needs at least {} primaries: it cannot know of a rare "
      "bright value that it never drew",
      help.text, floor_of_evidence);
  return help;
}

bool has_planned_size(const Question& question) {
  return question.test->detect || question.test->claim.relation == Relation::within;
}

double critical_value(double alpha, bool two_sided) {
  return stats::upper_normal_quantile(two_sided ? alpha / 2 : alpha);
}

std::size_t most_looks(const FamilyPlace& place) { return place.in_seconds ? 40 : 16; }

double kurtosis_limit(const Question& question, const FamilyPlace& place) {
  const bool planned = has_planned_size(question) && !question.test->secondaries;
  const double looks = planned ? static_cast<double>(most_looks(place)) : 1;
  const double critical =
      critical_value(place.share.alpha / looks, is_two_sided(question.test->claim.relation));
  return stats::kurtosis_limit_at(critical);
}

stats::ErrorRates planned_rates(const ErrorShare& share, const Regions& regions) {
  if (regions.relation == Relation::within) {
    return {.alpha = share.beta, .beta = share.beta / 2, .two_sided = false};
  }
  if (regions.proof()) return {.alpha = share.beta, .beta = share.beta, .two_sided = false};
  return {.alpha = share.alpha, .beta = share.beta, .two_sided = regions.two_sided()};
}

stats::MeanPlan mean_plan(const Sized& sized, int side) {
  stats::MeanPlan plan = mean_plan(sized.test.plan.method, sized.rates(), sized.channel, side);
  plan.allocation = sized.sizes().y / sized.sizes().x;
  return plan;
}

std::uint64_t secondaries_by_t(const Method& method, const stats::ErrorRates& rates,
                               const PlannedChannel& channel) {
  const double detect = *channel.regions.detect * channel.unit;
  return stats::student_t_sample_size(mean_plan(method, rates, channel, 0), detect)
      .value_or(impossible_secondaries);
}

std::uint64_t secondaries_of_floor(const TestOutcome& test) {
  std::uint64_t floor = least_secondaries;
  for (std::size_t i = 0; i < test.question.subjects.size(); ++i) {
    const Setup& setup = *test.question.subjects[i].setup;
    if (setup.observations() || setup.image() || setup.keeps_files()) continue;
    const std::uint64_t each = std::max<std::uint64_t>(1, test.plan.primaries[i]);
    floor = std::max(floor, (floor_of_evidence + each - 1) / each);
  }
  return floor;
}

stats::LookSchedule one_look(std::uint64_t secondaries, const ErrorShare& share) {
  return stats::one_look(secondaries, share.alpha, share.beta);
}

std::uint64_t primaries_of_look(const TestOutcome& test, std::uint64_t look) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < test.plan.primaries.size(); ++i) {
    const Subject& side = test.question.subjects[i];
    sum += primaries_of_observation(*side.setup, test.plan.primaries[i]) * side.secondaries(look);
  }
  return sum;
}

std::uint64_t whole_secondaries(double count) {
  return count < 0x1p53 ? static_cast<std::uint64_t>(std::ceil(count)) : impossible_secondaries;
}

bool all_piloted(const Question& question, const Pilots& pilots) {
  return std::ranges::all_of(question.subjects,
                             [&](const Subject& s) { return pilot_of(s, pilots) != nullptr; });
}

double distance_of(const Regions& regions) {
  return regions.detect ? *regions.detect - regions.allow : 0;
}

std::uint64_t Sized::secondaries() const { return test.plan.looks.sizes[look]; }

stats::ErrorRates Sized::rates() const {
  return planned_rates(test.share_at(look), channel.regions);
}

stats::SampleSizes Sized::sizes() const {
  const auto taken = [&](std::size_t subject) {
    return static_cast<double>(test.question.subjects[subject].secondaries(secondaries()));
  };
  return {.x = taken(0), .y = taken(test.question.of_two() ? 1 : 0)};
}

std::optional<double> detectable_effect(const Sized& sized) {
  const std::optional<double> found = sized.test.question.theta->detectable(sized);
  return found && std::isfinite(*found) ? found : std::nullopt;
}

}  // namespace assay::harness
