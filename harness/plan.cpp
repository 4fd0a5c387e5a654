#include "harness/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "harness/assumptions.h"
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
// Fewer say nothing about their own shape.
constexpr std::uint64_t first_look = 100;
// Half a day at 40 ns a primary.
constexpr double most_planned_primaries = 1e12;
// Each look doubles the sample. Ten cost a tenth to a third more at the last look (README.md) and
// let a test end after 1/512 of it.
constexpr double look_growth = 2;
constexpr std::size_t most_looks = 10;

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
    wanted = std::max(wanted, question.of_variances()
                                  ? stats::primaries_for_variance(shape, shape_limits(x))
                                  : stats::primaries_for_mean(shape, test));
  }
  return wanted;
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
    const stats::Gate gate = stats::predicted_skewness_gate(
        stats::primary_shape(pilot), averaged,
        {.secondaries = plan.most_secondaries(), .critical_value = x});
    plan.gates.push_back(gate_of(gate, pilot_label(question, subject, channel)));
  });
}

/// The most secondaries there are, or that a budget in primaries pays for, all subjects together.
std::uint64_t most_available(const Question& question, const Plan& plan) {
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  for (const Subject& subject : question.subjects) {
    most = std::min(most, subject.setup->observations().value_or(most));
  }
  const std::optional<Budget>& budget = question.test->budget;
  if (!budget || !budget->primaries) return most;
  const std::uint64_t each =
      std::accumulate(plan.primaries.begin(), plan.primaries.end(), std::uint64_t{0});
  return std::min(most, std::max<std::uint64_t>(2, *budget->primaries / each));
}

/// The fewest secondaries of which a test by this method means anything.
std::uint64_t least_secondaries(const Question& question, const FamilyPlace& place,
                                const Pilots& pilots, const Plan& plan) {
  if (plan.method.name == "log-variance") return log_variance_secondaries;
  if (!question.of_means() || question.test->method) return first_look;
  // Up to as many as the pilot's cap on primaries would cost; beyond, the gate says so.
  return std::clamp(skewness_secondaries(question, place, pilots, plan), first_look,
                    64 * classical_secondaries);
}

/// Stops before hours are spent on what was hardly meant.
void require_possible(const Question& question, const Plan& plan, std::uint64_t secondaries) {
  const Location& where = question.test->where;
  if (secondaries >= impossible_secondaries) {
    throw InputError(where,
                     "no number of observations would decide this claim: the reference's own "
                     "standard error is too large for the margin; give a larger margin or a "
                     "better reference");
  }
  const double total = static_cast<double>(secondaries) *
                       static_cast<double>(std::accumulate(plan.primaries.begin(),
                                                           plan.primaries.end(), std::uint64_t{0}));
  if (total <= most_planned_primaries) return;
  throw InputError(where, fmt::format("this claim would take about {:.1e} primaries; give a larger "
                                      "margin, or a `budget` to spend on it all the same",
                                      total));
}

stats::LookSchedule one_look(std::uint64_t secondaries) { return {{secondaries}, {1}}; }

bool is_bounded(const Question& question) {
  return std::any_of(question.subjects.begin(), question.subjects.end(),
                     [](const Subject& s) { return s.setup->observations().has_value(); });
}

/// Looks that double from the fewest that mean anything up to what `detect` needs at the last
/// look's share of the errors. One look where nothing asks for a number or the number is given: all
/// rows of a file, `secondaries`, the classical 1000.
stats::LookSchedule plan_looks(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, const Plan& plan) {
  const std::uint64_t most = most_available(question, plan);
  if (question.test->secondaries) return one_look(std::min(*question.test->secondaries, most));
  if (is_bounded(question)) return one_look(most);
  const std::uint64_t first = least_secondaries(question, place, pilots, plan);
  const std::optional<std::uint64_t> alone =
      planned_secondaries(question, place.share, pilots, plan);
  if (!alone) return one_look(std::min(std::max(first, classical_secondaries), most));
  if (most == std::numeric_limits<std::uint64_t>::max()) require_possible(question, plan, *alone);
  if (*alone <= first) return one_look(std::min(first, most));
  const std::size_t count =
      std::min<std::size_t>(most_looks, 1 + std::bit_width((*alone - 1) / first));
  const double weight = 1 / static_cast<double>(count);
  const ErrorShare share{.alpha = place.share.alpha * weight, .beta = place.share.beta * weight};
  const std::uint64_t last =
      std::min(most, planned_secondaries(question, share, pilots, plan).value_or(*alone));
  if (last <= first) return one_look(last);
  return stats::geometric_looks({.first = std::max(first, (last >> (count - 1)) + 1), .last = last},
                                look_growth);
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
    if (!question.of_means() && !question.of_variances()) continue;
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
      .regions = regions_of(question)};
  const bool laws = !question.of_means() && !question.of_variances();
  for (const Subject& subject : question.subjects) {
    const bool single = laws && !subject.estimator->primaries;
    plan.primaries.push_back(single ? 1 : primaries_of(subject, primaries));
  }
  if (question.of_variances()) choose_variance_method(question, place, pilots, plan);
  try {
    plan.looks = plan_looks(question, place, pilots, plan);
  } catch (const std::domain_error& error) {
    plan.looks = one_look(first_look);
    plan.invalid = error.what();
  }
  if (question.of_means()) add_skewness_gates(question, place, pilots, plan);
  return plan;
}

}  // namespace assay::harness
