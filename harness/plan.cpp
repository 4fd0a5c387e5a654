#include "harness/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "harness/constant.h"
#include "harness/sample_size.h"
#include "stats/assumption_gates.h"
#include "stats/tails.h"

namespace assay::harness {
namespace {

constexpr std::uint64_t classical_secondaries = 1000;
// Below this the cost of an observation (stream, moments) shows against 20 ns a primary.
constexpr std::uint64_t least_primaries = 64;
// Beyond this a larger mean no longer tames the tail in reasonable time: another method, or none.
constexpr std::uint64_t most_primaries = 4096;
// log-variance keeps its level up to here at 1000 observations and more (an exponential has 6).
constexpr double log_variance_kurtosis = 6;
constexpr std::uint64_t log_variance_secondaries = 1000;

bool about_variance(const Question& question) {
  return question.kind == QuestionKind::variance_of_one ||
         question.kind == QuestionKind::variance_of_two;
}

bool about_mean(const Question& question) {
  return question.kind == QuestionKind::mean_of_one || question.kind == QuestionKind::mean_of_two;
}

bool chooses_primaries(const Subject& subject) {
  return subject.averages && subject.purpose.empty() && !subject.estimator->primaries;
}

bool two_sided(const Question& question) {
  return Regions{.relation = question.test->claim.relation}.two_sided();
}

/// Excess kurtosis at which the level of chi-square and F is 1.25 times nominal: x is divided by
/// sqrt(1 + excess / 2), so the bound is stricter at smaller levels.
stats::ShapeLimits shape_limits(double critical) {
  const double log_tail = stats::normal_tails(critical).upper;
  const double nearer = stats::normal_quantile({stats::Tail::upper, log_tail + std::log(1.25)});
  const double inflation = critical / nearer;
  return {.excess_kurtosis = std::min(0.2, 2 * (inflation * inflation - 1)), .level_factor = 1.25};
}

const stats::Moments& pilot_of(const Question& question, std::size_t subject, std::size_t channel,
                               const Pilots& pilots) {
  const Subject& side = question.subjects[subject];
  return pilots.at(side.estimator->name).channels[side.channels[channel]];
}

bool has_pilot(const Subject& subject, const Pilots& pilots) {
  const auto found = pilots.find(subject.estimator->name);
  return found != pilots.end() && found->second.trouble.empty();
}

/// Primaries that one question asks of one of its estimators.
std::uint64_t wanted_primaries(const Question& question, const FamilyPlace& place,
                               std::size_t subject, const Pilots& pilots) {
  const double x = critical_value(place.share.alpha, two_sided(question));
  std::uint64_t wanted = least_primaries;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const stats::Moments& pilot = pilot_of(question, subject, channel, pilots);
    if (is_constant(question, subject, channel, pilot)) continue;
    const stats::PrimaryShape shape = stats::primary_shape(pilot);
    const stats::PlannedTest test{
        .secondaries = question.test->secondaries.value_or(classical_secondaries),
        .critical_value = x};
    wanted = std::max(wanted, about_variance(question)
                                  ? stats::primaries_for_variance(shape, shape_limits(x))
                                  : stats::primaries_for_mean(shape, test));
  }
  return wanted;
}

reports::Gate gate_of(const stats::Gate& gate, const std::string& where) {
  constexpr const char* states[] = {"green", "amber", "red"};
  return {.name = gate.name + where,
          .value = gate.value,
          .limit = gate.limit,
          .state = states[static_cast<int>(gate.state)]};
}

std::string pilot_label(const Question& question, std::size_t subject, std::size_t channel) {
  const Subject& side = question.subjects[subject];
  const std::string name =
      question.channel_count() > 1 ? "." + side.setup->channels()[side.channels[channel]].name : "";
  return fmt::format(", pilot of {}{}", side.estimator->name, name);
}

/// Every (subject, channel) that has a spread in its pilot.
template <class Visit>
void each_pilot(const Question& question, const Pilots& pilots, Visit&& visit) {
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    if (!has_pilot(question.subjects[subject], pilots)) continue;
    for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
      const stats::Moments& pilot = pilot_of(question, subject, channel, pilots);
      if (!is_constant(question, subject, channel, pilot)) visit(subject, channel, pilot);
    }
  }
}

/// F and chi-square where the pilot predicts near-normal secondaries; else the logarithm of the
/// variance with its own kurtosis; else nothing.
void choose_variance_method(const Question& question, const FamilyPlace& place,
                            const Pilots& pilots, Plan& plan) {
  const stats::ShapeLimits limits =
      shape_limits(critical_value(place.share.alpha, two_sided(question)));
  bool normal = true;
  bool piloted = true;
  double largest = 0;
  for (const Subject& subject : question.subjects) piloted &= has_pilot(subject, pilots);
  each_pilot(question, pilots, [&](std::size_t subject, std::size_t channel, const auto& pilot) {
    const stats::PrimaryShape shape = stats::primary_shape(pilot);
    const std::uint64_t averaged =
        question.subjects[subject].averages ? plan.primaries[subject] : 1;
    const stats::Gate gate = stats::predicted_kurtosis_gate(shape, averaged, limits);
    plan.gates.push_back(gate_of(gate, pilot_label(question, subject, channel)));
    normal = normal && gate.state == stats::GateState::green;
    largest = std::max(largest, gate.value);
  });
  if (question.test->method) return;
  if (normal && piloted) return;
  plan.method = find_method(question, "log-variance");
  for (reports::Gate& gate : plan.gates) {
    if (gate.state == "red") gate.state = "amber";  // answered by the method chosen
  }
  if (largest > log_variance_kurtosis) {
    plan.invalid = fmt::format(
        "the pilot's excess kurtosis of {:.3g} is too large for any variance test here (at most "
        "{:g}); a larger `primaries` brings the secondary estimates nearer to normal",
        largest, log_variance_kurtosis);
  }
}

/// Total observations at which the worse tail of a mean test is right within a quarter.
std::uint64_t skewness_secondaries(const Question& question, const FamilyPlace& place,
                                   const Pilots& pilots, const Plan& plan) {
  const double x = critical_value(place.share.alpha, two_sided(question));
  std::uint64_t needed = 0;
  each_pilot(question, pilots, [&](std::size_t subject, std::size_t, const auto& pilot) {
    // Only the product of primaries and secondaries matters.
    const std::uint64_t total =
        2 * stats::primaries_for_mean(stats::primary_shape(pilot),
                                      {.secondaries = 2, .critical_value = x});
    const std::uint64_t averaged =
        question.subjects[subject].averages ? plan.primaries[subject] : 1;
    needed = std::max(needed, (total + averaged - 1) / averaged);
  });
  return needed;
}

void add_skewness_gates(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                        Plan& plan) {
  const double x = critical_value(place.share.alpha, two_sided(question));
  each_pilot(question, pilots, [&](std::size_t subject, std::size_t channel, const auto& pilot) {
    const std::uint64_t averaged =
        question.subjects[subject].averages ? plan.primaries[subject] : 1;
    const stats::Gate gate =
        stats::predicted_skewness_gate(stats::primary_shape(pilot), averaged,
                                       {.secondaries = plan.secondaries, .critical_value = x});
    plan.gates.push_back(gate_of(gate, pilot_label(question, subject, channel)));
  });
}

/// The most observations a bounded source has.
std::uint64_t available(const Question& question) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (const Subject& subject : question.subjects) {
    least = std::min(least, subject.setup->observations().value_or(least));
  }
  return least;
}

std::uint64_t choose_secondaries(const Question& question, const FamilyPlace& place,
                                 const Pilots& pilots, Plan& plan) {
  const std::uint64_t most = available(question);
  if (question.test->secondaries) return *question.test->secondaries;
  if (most < std::numeric_limits<std::uint64_t>::max()) return most;
  std::uint64_t count =
      planned_secondaries(question, place.share, pilots, plan).value_or(classical_secondaries);
  if (about_mean(question) && !question.test->method) {
    // Up to as many again as the pilot's cap on primaries would cost; beyond, the gate says so.
    count = std::max(count, std::min(skewness_secondaries(question, place, pilots, plan),
                                     64 * std::max(count, classical_secondaries)));
  }
  if (plan.method.name == "log-variance") count = std::max(count, log_variance_secondaries);
  return count;
}

/// The most observations that a budget in primaries pays for, all subjects together.
std::uint64_t within_budget(const Question& question, const Plan& plan, std::uint64_t count) {
  const std::optional<Budget>& budget = question.test->budget;
  if (!budget || !budget->primaries) return count;
  const std::uint64_t each =
      std::accumulate(plan.primaries.begin(), plan.primaries.end(), std::uint64_t{0});
  return std::clamp<std::uint64_t>(*budget->primaries / each, 2, count);
}

std::uint64_t primaries_of(const Subject& subject, const Primaries& chosen) {
  if (!subject.purpose.empty()) return 1;
  if (subject.estimator->primaries) return *subject.estimator->primaries;
  const auto found = chosen.find(subject.estimator->name);
  return found != chosen.end() ? found->second : 1;
}

std::vector<Regions> regions_of(const Question& question) {
  const TestEntry& test = *question.test;
  std::vector<Regions> all;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    Regions regions{.relation = test.claim.relation};
    if (test.allow) regions.allow = margin_on_theta(question, channel, *test.allow);
    if (test.detect) regions.detect = margin_on_theta(question, channel, *test.detect);
    if (regions.relation == Relation::within) {
      regions.within = margin_on_theta(question, channel, test.claim.margin);
    }
    all.push_back(regions);
  }
  return all;
}

}  // namespace

double critical_value(double alpha, bool two_sided) {
  return stats::normal_quantile({stats::Tail::upper, std::log(two_sided ? alpha / 2 : alpha)});
}

Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots) {
  Primaries chosen;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const Question& question = questions[i];
    if (!about_mean(question) && !about_variance(question)) continue;
    for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
      const Subject& side = question.subjects[subject];
      if (!chooses_primaries(side) || !has_pilot(side, pilots)) continue;
      const std::uint64_t wanted = wanted_primaries(question, places[i], subject, pilots);
      std::uint64_t& primaries = chosen[side.estimator->name];
      // A power of two: another seed's pilot then mostly chooses the same.
      primaries = std::max(primaries, std::bit_ceil(std::min(wanted, most_primaries)));
    }
  }
  return chosen;
}

Plan plan_test(const Question& question, const FamilyPlace& place, const Pilots& pilots,
               const Primaries& primaries) {
  const TestEntry& test = *question.test;
  Plan plan{
      .method = test.method ? find_method(question, *test.method) : methods_for(question).front(),
      .primaries = {},
      .regions = regions_of(question)};
  const bool laws = !about_mean(question) && !about_variance(question);
  for (const Subject& subject : question.subjects) {
    const bool single = laws && !subject.estimator->primaries;
    plan.primaries.push_back(single ? 1 : primaries_of(subject, primaries));
  }
  if (about_variance(question)) choose_variance_method(question, place, pilots, plan);
  plan.secondaries =
      within_budget(question, plan, choose_secondaries(question, place, pilots, plan));
  if (about_mean(question)) add_skewness_gates(question, place, pilots, plan);
  return plan;
}

}  // namespace assay::harness
