#include "harness/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "harness/sampling/pool.h"
#include "harness/theta/ask.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {
namespace {

std::vector<Regions> regions_of(const Question& question) {
  const TestEntry& test = *question.test;
  return mapped_indices(question.channel_count(), [&](std::size_t channel) {
    Regions regions{.relation = test.claim.relation};
    if (test.allow) regions.allow = margin_on_theta(question, channel, *test.allow);
    if (test.detect) regions.detect = margin_on_theta(question, channel, *test.detect);
    if (regions.within()) regions.detect = margin_on_theta(question, channel, test.claim.margin);
    return regions;
  });
}

/// Names the estimator whose pilot gave a value that is not finite; "" if none did. Rows of files
/// are the test's own.
std::string not_finite_in_pilot(const Question& question, const Pilots& pilots) {
  for (const Subject& subject : question.subjects) {
    const Pilot* const pilot = pilot_of(subject, pilots);
    if (pilot == nullptr || is_recorded(subject)) continue;
    for (const std::size_t channel : subject.channels.all()) {
      const ChannelSummary& seen = pilot->sums->channels[channel];
      if (seen.nonfinite == 0) continue;
      return fmt::format(
          "{} of {} observations of `{}` in the pilot {} not finite, the first is observation {}",
          seen.nonfinite, pilot->sums->count, subject.estimator->name,
          seen.nonfinite == 1 ? "is" : "are", seen.first_nonfinite);
    }
  }
  return "";
}

/// Why a subject's observations are no means of its primaries; "" if they may be.
std::string no_averages(const Subject& subject, const Pilot& single, const Pilot& averaged) {
  for (std::size_t channel = 0; channel < subject.channels.size(); ++channel) {
    if (subject.declared(channel).diagnostic) continue;
    const ChannelData primaries = pilot_channel(subject, single, channel);
    const ChannelData means = pilot_channel(subject, averaged, channel);
    if (means.moments.count < means.values.size() ||
        primaries.moments.count < primaries.values.size()) {
      continue;  // not finite: another fault
    }
    constexpr double rounding = 1e-12;  // relative, of sums of primaries
    if (primaries.moments.standard_deviation() <= rounding * std::abs(primaries.moments.mean)) {
      continue;
    }
    const std::uint64_t each = averaged.primaries;
    if (stats::averages_gate(primaries.values, means.values, each).state != stats::GateState::red) {
      continue;
    }
    return fmt::format(
        "`{0}` declares `averages`, but its observations of {1} primaries are no means of {1} of "
        "its primaries: their variance times {1} is {2:.3g} times that of one primary, their mean "
        "is {3:.4g} and that of one primary {4:.4g}; average `primaries` independent primaries, or "
        "leave `averages` out",
        subject.estimator->name, each,
        static_cast<double>(each) * means.moments.variance() / primaries.moments.variance(),
        means.moments.mean, primaries.moments.mean);
  }
  return "";
}

/// Names the estimator whose pilot broke a declaration; "" if none did. Single primaries show what
/// means may hide.
std::string misdeclared(const Question& question, const Pilots& pilots) {
  for (const Subject& subject : question.subjects) {
    const Pilot* const pilot = pilot_of(subject, pilots);
    if (pilot == nullptr) continue;
    if (std::string fault = outside_of_range(subject, *pilot->sums); !fault.empty()) return fault;
    const Pilot* const averaged = averaged_pilot_of(subject, pilots);
    if (averaged == nullptr) continue;
    if (std::string fault = no_averages(subject, *pilot, *averaged); !fault.empty()) return fault;
  }
  return "";
}

/// Why the pilot cannot choose: powers of its values are beyond doubles. Empty if none are.
std::string unusable_pilot(const Question& question, const Pilots& pilots) {
  if (question.is().of_single_values) return "";
  for (const Subject& side : question.subjects) {
    const Pilot* pilot = pilot_of(side, pilots);
    if (pilot == nullptr || pilot->sums->elements || !side.purpose.empty()) continue;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const stats::Moments moments = pilot->moments(side.channels[channel]);
      const std::string reason = beyond_doubles(moments, side.estimator->name);
      if (!reason.empty() && !is_constant(side, channel, moments)) return reason;
    }
  }
  return "";
}

/// A margin larger than the other side, which `ask_as_written` cannot know; "" if there is none.
std::string larger_than_other_side(const Question& question, const Pilots& pilots) {
  if (question.written.empty() || !has_margin(*question.test, false)) return "";
  const double size = question.theta->known_size(question, &pilots);
  for (const Margin& margin : question.written) {
    if (const auto text = missing_per_cent(margin, size); !text.empty())
      return "the margin " + text;
  }
  return "";
}

/// Chooses the method by the pilots' shapes, then judges the order of rows and draws. Returns the
/// fewest secondaries that the method takes.
std::uint64_t choose_method(TestOutcome& test, const Pilots& pilots, std::uint64_t most) {
  const Question& question = test.question;
  const std::uint64_t used = std::min(most, question.test->secondaries.value_or(most));
  if (has_rows(question)) require_independent_sides(question, pilots, used);
  std::string reason = unusable_pilot(question, pilots);
  if (reason.empty()) reason = larger_than_other_side(question, pilots);
  if (!reason.empty()) {
    test.plan.invalid = std::move(reason);
    return least_secondaries;
  }
  const std::uint64_t least = question.theta->choose(test, pilots);
  if (has_rows(question)) judge_independence(test, pilots, used);
  for (const Subject& side : question.subjects) {
    const Pilot* const pilot = pilot_of(side, pilots);
    if (pilot == nullptr || !pilot->drawn) continue;
    judge_order(side, *pilot->drawn, test.plan.gates, test.plan.invalid);
  }
  return least;
}

// Below this the cost of an observation shows: its stream and moments.
constexpr std::uint64_t least_primaries = 64;
// Beyond this a larger mean no longer tames the tail in reasonable time.
constexpr std::uint64_t most_primaries = 4096;

std::uint64_t wanted_primaries(const Question& question, const FamilyPlace& place,
                               std::size_t subject, const Pilots& pilots) {
  std::uint64_t wanted = least_primaries;
  if (!question.is().of_spread) return wanted;
  const double limit = kurtosis_limit(question, place);
  for (std::size_t channel = 0; channel < question.subjects[subject].channels.size(); ++channel) {
    const stats::Moments& pilot = pilot_channel(question, subject, channel, pilots).moments;
    if (is_constant(question.subjects[subject], channel, pilot)) continue;
    if (!beyond_doubles(pilot, "").empty()) continue;  // the plan says so
    wanted = std::max(wanted, stats::primaries_for_variance(pilot.kurtosis() - 3, limit));
  }
  return wanted;
}

// Half a day at 40 ns a primary.
constexpr double most_planned_primaries = 1e12;
// A test may draw so many times its first look, although it needs less, while a gate is red.
constexpr std::uint64_t waiting_looks = 4;
// The last look may be put off to so many times its size.
constexpr std::uint64_t most_postponed = 64;
// Fewest secondaries that have a spread.
constexpr std::uint64_t fewest_tested = 2;

/// The look that a budget in primaries pays for beside the pilots. Throws InputError if it buys
/// fewer than two secondaries of each subject.
std::uint64_t paid_for(const TestOutcome& test, std::uint64_t whole, std::uint64_t pilots) {
  const std::uint64_t each = primaries_of_look(test, 1);
  const std::uint64_t budget = whole - std::min(whole, pilots);
  std::uint64_t paid = budget / each;
  // Subjects without more secondaries leave their part to the others.
  while (paid >= fewest_tested) {
    const std::uint64_t next = primaries_of_look(test, paid + 1);
    const std::uint64_t spent = primaries_of_look(test, paid);
    if (next == spent || next > budget) return paid;
    paid += (budget - spent) / (next - spent);
  }
  refuse(
      test.question.test->place_of("budget"),
      "its budget (or its share of the suite's), {} primaries, must pay for {} of the pilot and at "
      "least {} of the test; give a larger budget, or fewer `primaries`",
      whole, pilots, fewest_tested * each);
}

/// Throws InputError before hours are spent on what was hardly meant.
void require_possible(const TestOutcome& test, std::uint64_t secondaries) {
  const Question& question = test.question;
  const Location& where = question.test->place_of(question.test->detect ? "detect" : "claim");
  if (secondaries >= impossible_secondaries) {
    refuse(where, question.theta->why_impossible(question));
  }
  const double total =
      static_cast<double>(secondaries) * static_cast<double>(primaries_of_look(test, 1));
  if (total <= most_planned_primaries) return;
  refuse(where,
         "this claim would take about {:.1e} primaries; give a larger margin, or the `budget` that "
         "it may spend",
         total);
}

/// One look of a method in seconds: replicates of whole blocks, with as many observations for each
/// subject.
stats::LookSchedule timed_look(const TestOutcome& test, std::uint64_t secondaries) {
  std::uint64_t block = 1;
  for (const std::uint64_t primaries : test.plan.primaries) {
    block = std::max(block, block_size_of(primaries));
  }
  const std::uint64_t unit = block * replicate_count;
  return one_look(std::max<std::uint64_t>(1, (secondaries + unit - 1) / unit) * unit,
                  test.place.share);
}

/// The largest look. It has the rows of the longest file, also for a side drawn beside it. A budget
/// in primaries pays for it after the pilots.
std::uint64_t most_available(const TestOutcome& test, const Pilots& pilots) {
  const std::uint64_t most =
      test.question.most_rows().value_or(std::numeric_limits<std::uint64_t>::max());
  const std::optional<Budget>& budget = test.question.test->budget;
  if (!budget || !budget->primaries) return most;
  return std::min(most,
                  paid_for(test, *budget->primaries, primaries_of_pilots(test.question, pilots)));
}

/// The most secondaries where a budget in seconds does not pay for the fewest meaningful ones at
/// the pilot's speed. It is a power of two, as clocks differ, and two at least.
std::uint64_t most_in_seconds(const TestOutcome& test, const Pilots& pilots,
                              const stats::LookRange& range) {
  const std::optional<Budget>& budget = test.question.test->budget;
  if (!budget || !budget->seconds || test.question.subjects[0].image) return range.last;
  double each = 0;
  for (std::size_t i = 0; i < test.plan.primaries.size(); ++i) {
    const auto cost = observation_cost(test.question.subjects[i], test.plan.primaries[i], pilots);
    each += cost ? cost->seconds : 0;
  }
  const double paid = std::max(2.0, *budget->seconds / each);
  if (!(paid < static_cast<double>(range.first))) return range.last;
  return std::min(range.last, std::bit_floor(static_cast<std::uint64_t>(paid)));
}

/// Throws InputError if somebody chose the size of a claim in seconds.
void require_no_budget(const TestOutcome& test) {
  const TestEntry& entry = *test.question.test;
  if (test.plan.method.keeps != Keeps::blocks || !entry.budget) return;
  refuse(entry.place_of("budget"),
         "a claim in seconds times whole replicates, which a `budget` cannot end: leave it out, or "
         "give `secondaries`, which are rounded up");
}

/// Looks grow from the fewest meaningful observations to what `detect` needs at the last look's
/// levels. There is one look without `detect`, and if rows of a file or `secondaries` give the
/// number. The argument `range` has the fewest meaningful and the most available.
stats::LookSchedule plan_looks(const TestOutcome& test, const Pilots& pilots,
                               const stats::LookRange& range) {
  const auto [first, most] = range;
  const Question& question = test.question;
  const TestEntry& entry = *question.test;
  const ErrorShare& whole = test.place.share;
  if (test.plan.method.keeps == Keeps::blocks) {
    const auto planned =
        entry.secondaries ? entry.secondaries : question.theta->secondaries(test, whole, pilots);
    if (planned) require_possible(test, *planned);
    return timed_look(test, std::max(first, planned.value_or(usual_secondaries)));
  }
  if (entry.secondaries) {
    const std::uint64_t given = std::min(*entry.secondaries, most);
    if (!entry.budget) require_possible(test, given);
    return one_look(given, whole);
  }
  if (has_rows(question)) return one_look(most, whole);
  const std::optional<std::uint64_t> alone = question.theta->secondaries(test, whole, pilots);
  const std::uint64_t classical =
      test.plan.method.keeps == Keeps::images ? classical_replicates : usual_secondaries;
  if (!alone) return one_look(std::min(std::max(first, classical), most), whole);
  if (most == std::numeric_limits<std::uint64_t>::max()) require_possible(test, *alone);
  const stats::LookLaw law = test.plan.method.is.over_looks;
  const bool may_wait = law == stats::LookLaw::independent_increments;
  const std::uint64_t least = may_wait ? waiting_looks * first : first;
  const std::uint64_t needed = std::max(*alone, least);
  if (needed <= first) return one_look(std::min(first, most), whole);
  const auto size = [&](double alpha, double beta) {
    return question.theta->secondaries(test, {.alpha = alpha, .beta = beta}, pilots)
        .value_or(impossible_secondaries);
  };
  const auto looks =
      stats::growing_looks({.law = law,
                            .errors = {.alpha = whole.alpha,
                                       .beta = whole.beta,
                                       .two_sided = is_two_sided(entry.claim.relation)},
                            .first = first,
                            .least = least,
                            .needed = needed,
                            .most = most,
                            .count = most_looks(test.place)},
                           size);
  if (looks) return *looks;
  return one_look(std::min(std::max(first, *alone), most), whole);
}

/// The only look of a plan may be put off to these sizes. Each is twice the one before, the last at
/// most 64 times the look, and `most`. Empty with several looks, or if somebody chose the size.
std::vector<std::uint64_t> postponed_looks(const TestOutcome& test, std::uint64_t most) {
  const Question& question = test.question;
  const Plan& plan = test.plan;
  const bool chosen = question.test->secondaries || has_rows(question);
  if (chosen || plan.method.is.over_looks != stats::LookLaw::independent_increments) return {};
  std::vector<std::uint64_t> sizes;
  std::uint64_t size = plan.most_secondaries();
  for (std::uint64_t times = 2; times <= most_postponed && size < most; times *= 2) {
    size = std::min(2 * size, most);
    sizes.push_back(size);
  }
  return sizes;
}

/// The look of a test that is invalid beforehand. It decides nothing; it shows the estimators'
/// data.
stats::LookSchedule look_for_its_picture(const TestOutcome& test) {
  const bool given = test.question.test->secondaries || has_rows(test.question);
  if (given || test.plan.method.keeps == Keeps::blocks) return test.plan.looks;
  return one_look(std::min(test.plan.looks.sizes.front(), usual_secondaries), test.place.share);
}

bool inside_family(const Question& question) {
  const auto is_mutant = [](const Subject& side) {
    return !side.estimator->entry->information.original.empty();
  };
  return question.test->expect == reports::Verdict::pass &&
         std::ranges::none_of(question.subjects, is_mutant);
}

using StoppingLooks = std::vector<stats::StoppingLook>;

/// The standard error of theta's estimate at a look of this size.
double error_at_look(const TestOutcome& test, const PlannedChannel& channel, std::uint64_t look) {
  double error = channel.reference_error;
  for (std::size_t i = 0; i < test.question.compared(); ++i) {
    const auto count = static_cast<double>(test.question.subjects[i].secondaries(look));
    error = std::hypot(error, channel.deviations[i] / std::sqrt(count));
  }
  return error / channel.unit;
}

std::optional<StoppingLooks> stopping_looks(const TestOutcome& test, std::size_t channel,
                                            const Pilots& pilots) {
  if (!test.question.is().of_moments) return std::nullopt;
  const auto planned = test.question.theta->planned(test, channel, pilots);
  if (!planned) return std::nullopt;
  StoppingLooks looks;
  for (std::size_t k = 0; k < test.plan.looks.count(); ++k) {
    const double error = error_at_look(test, *planned, test.plan.looks.sizes[k]);
    if (!(error > 0) || !std::isfinite(error)) return std::nullopt;
    const Regions& regions = test.plan.regions[channel];
    const auto [alpha, beta] = test.share_at(k);
    looks.push_back(stats::stopping_look({.claimed = regions.claimed_edge(),
                                          .forbidden = regions.forbidden_edge(),
                                          .two_sided = regions.two_sided()},
                                         error, alpha, beta));
  }
  return looks;
}

/// Adds the outlooks, where the pilots give every channel a standard error.
void foresee(const TestOutcome& test, const Pilots& pilots, Forecast& found) {
  const bool bets = test.plan.looks.law == stats::LookLaw::anytime_valid;
  if (bets || test.plan.method.is.of_batches) return;
  std::vector<stats::Outlook> if_true;
  std::optional<stats::Outlook> if_off;
  for (std::size_t channel = 0; channel < test.question.channel_count(); ++channel) {
    const auto looks = stopping_looks(test, channel, pilots);
    if (!looks) return;
    const Regions& regions = test.plan.regions[channel];
    const bool one_sided_proof = regions.proof() && !regions.two_sided();
    if (!one_sided_proof || regions.detect) {
      if_true.push_back(
          stats::outlook_at(*looks, one_sided_proof ? -*regions.detect : 0, test.plan.looks.sizes));
    }
    if (const std::optional<double> edge = regions.forbidden_edge()) {
      const stats::Outlook off = stats::outlook_at(*looks, *edge, test.plan.looks.sizes);
      if (!if_off || off.pass > if_off->pass) if_off = off;
    }
  }
  if (!if_true.empty()) found.if_true = stats::together(if_true);
  found.if_off = if_off;
}

std::optional<double> detectable_of(const TestOutcome& test, const Pilots& pilots) {
  std::optional<double> largest;
  if (test.plan.method.is.of_batches) return largest;
  for (std::size_t channel = 0; channel < test.question.channel_count(); ++channel) {
    const auto planned = test.question.theta->planned(test, channel, pilots);
    if (!planned) return std::nullopt;
    const auto found = detectable_effect({test, test.plan.looks.count() - 1, *planned});
    if (found) largest = std::max(*found, largest.value_or(0));
  }
  return largest;
}

}  // namespace

std::vector<FamilyPlace> places(const Suite& suite, const std::vector<Question>& questions) {
  std::vector<FamilyPlace> all;
  double inside_weight = 0;
  double all_weight = 0;
  int outside = 0;
  const auto count = [&](const TestEntry& test, bool inside) {
    all_weight += test.weight;
    inside_weight += inside ? test.weight : 0;
    outside += inside ? 0 : 1;
  };
  const auto timed = [](const std::optional<Budget>& budget) { return budget && budget->seconds; };
  for (const Question& question : questions) {
    all.push_back({.inside = inside_family(question),
                   .in_seconds = timed(suite.budget) || timed(question.test->budget)});
    count(*question.test, all.back().inside);
  }
  // A test whose source died keeps its part: the others' numbers do not change.
  double least_untested = std::numeric_limits<double>::infinity();
  for (const TestEntry& test : suite.tests) {
    const auto asks = [&](const Question& question) { return question.test == &test; };
    if (std::ranges::any_of(questions, asks)) continue;
    const bool inside = test.expect == reports::Verdict::pass;
    count(test, inside);
    if (inside) least_untested = std::min(least_untested, test.weight);
  }
  const double total = inside_weight > 0 ? inside_weight : all_weight;
  double smallest = suite.alpha * least_untested / total;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double weight =
        questions[i].test->weight / total / static_cast<double>(questions[i].channel_count());
    all[i].weight = all[i].inside ? weight : 0;
    all[i].share = {.alpha = suite.alpha * weight, .beta = suite.beta};
    if (all[i].inside || inside_weight == 0) smallest = std::min(smallest, all[i].share.alpha);
  }
  for (FamilyPlace& place : all) {
    if (!place.inside) place.share = {.alpha = smallest, .beta = suite.beta / outside};
  }
  return all;
}

std::string lack_of_density(const Question& question, const NoDensity& why) {
  return fmt::format("the density that `{}` declares cannot be computed: {}",
                     question.subjects[0].estimator->name, why.what());
}

TestOutcome plan_test(Question asked, const FamilyPlace& place, const Pilots& pilots,
                      const Primaries& primaries) {
  TestOutcome test{.question = std::move(asked), .place = place};
  const Question& question = test.question;
  const std::optional<std::string>& forced = question.test->method;
  Plan& plan = test.plan;
  plan = {.method = forced ? find_method(question, *forced) : methods_for(question).front(),
          .regions = regions_of(question)};
  const bool single = question.theta->takes_single_primaries(question, pilots);
  for (const Subject& subject : question.subjects) {
    const auto found = primaries.find(subject.estimator->name);
    const std::uint64_t chosen = single || found == primaries.end() ? 1 : found->second;
    const bool is_draw = !subject.purpose.empty();
    plan.primaries.push_back(is_draw ? 1 : subject.estimator->primaries.value_or(chosen));
  }
  // The look of a test that nothing decides. Files are there whole.
  const bool files = std::ranges::all_of(question.subjects, is_recorded);
  plan.looks = one_look(files ? question.most_rows().value_or(2) : 2, place.share);
  plan.pilot_error = not_finite_in_pilot(question, pilots);
  plan.error = where_pilots_stopped(question, pilots);
  if (plan.error.empty()) plan.error = misdeclared(question, pilots);
  if (!plan.error.empty()) return test;
  require_no_budget(test);
  try {
    question.theta->require_density(question);
    std::uint64_t most = most_available(test, pilots);
    const std::uint64_t least = choose_method(test, pilots, most);
    most = most_in_seconds(test, pilots, {.first = least, .last = most});
    plan.looks = plan_looks(test, pilots, {.first = least, .last = most});
    if (plan.invalid.empty()) plan.invalid = question.theta->too_few(test);
    if (plan.invalid.empty()) {
      plan.postponed = postponed_looks(test, most);
    } else {
      plan.looks = look_for_its_picture(test);
    }
    const auto caution = [&](const std::string& words) {
      plan.caution += (plan.caution.empty() ? "" : "; ") + words;
    };
    if (question.test->detect_by_default) {
      caution(fmt::format("`detect` is {}, the default for claims about laws",
                          question.test->detect->value));
    }
    if (const std::string doubt = doubtful_margin(question, pilots); !doubt.empty()) caution(doubt);
    const std::optional<ImageShape>& image = question.subjects[0].image;
    if (image && image->left_out) {
      caution(fmt::format("{} of {} pixels are left out: what is wrong there stays hidden",
                          std::ranges::count(*image->left_out, true), image->pixels()));
    }
  } catch (const std::domain_error& error) {
    plan.invalid = in_words(error);
  } catch (const NoDensity& failure) {
    plan.error = lack_of_density(question, failure);
  } catch (const InputError& mistake) {  // that the pilots show
    plan.error = mistake.message();
  }
  return test;
}

std::string doubtful_margin(const Question& question, const Pilots& pilots) {
  constexpr double large = 0.1, small = 1e-4;
  const std::optional<Margin>& detect = question.test->detect;
  if (!detect || detect->relative) return "";
  const double size = question.theta->known_size(question, &pilots);
  const double part = detect->value / size;
  if (!(size > 0) || (part >= small && part <= large)) return "";
  return fmt::format(
             fmt::runtime(part > large
                              ? "errors below `detect`, {:.3g} % of what is claimed, may pass"
                              : "`detect` is {:.3g} % of what is claimed"),
             100 * part) +
         "; for a part of it write per cent, as in `1%`";
}

TestOutcome plan_alone(const Suite& suite, const Question& question, const Pilots& pilots) {
  const std::vector<FamilyPlace> place = places(suite, {question});
  return plan_test(question, place[0], pilots, choose_primaries({question}, place, pilots));
}

Primaries choose_primaries(const std::vector<Question>& questions,
                           const std::vector<FamilyPlace>& places, const Pilots& pilots) {
  Primaries chosen;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const Question& question = questions[i];
    if (question.theta->takes_single_primaries(question, pilots)) continue;
    for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
      const Subject& side = question.subjects[subject];
      if (!side.averages || !side.purpose.empty() || side.estimator->primaries) continue;
      if (pilot_of(side, pilots) == nullptr) continue;
      const std::uint64_t wanted = wanted_primaries(question, places[i], subject, pilots);
      std::uint64_t& primaries = chosen[side.estimator->name];
      // A power of two: pilots of other seeds mostly choose the same.
      primaries = std::max(primaries, std::bit_ceil(std::min(wanted, most_primaries)));
    }
  }
  // Sides of a pair draw the same random numbers only if they draw as many.
  for (bool moved = true; moved;) {
    moved = false;
    for (const Question& question : questions) {
      if (!question.is().of_pairs) continue;
      const auto first = chosen.find(question.subjects[0].estimator->name);
      const auto second = chosen.find(question.subjects[1].estimator->name);
      if (first == chosen.end() || second == chosen.end()) continue;
      moved = moved || first->second != second->second;
      first->second = second->second = std::max(first->second, second->second);
    }
  }
  return chosen;
}

Forecast forecast(const TestOutcome& test, const Pilots& pilots) {
  if (!test.plan.error.empty() || !test.plan.pilot_error.empty()) return {};
  if (!test.plan.invalid.empty()) return {.if_true = stats::Outlook{}, .if_off = stats::Outlook{}};
  Forecast found{.detectable = detectable_of(test, pilots)};
  foresee(test, pilots, found);
  return found;
}

std::optional<PilotedCost> observation_cost(const Subject& subject, std::uint64_t primaries,
                                            const Pilots& pilots) {
  const Pilot* pilot = averaged_pilot_of(subject, pilots);
  if (pilot == nullptr) pilot = pilot_of(subject, pilots);
  const bool is_draw = pilot == nullptr;
  if (is_draw) pilot = pilots.find(subject.estimator->name);
  if (pilot == nullptr || pilot->sums == nullptr || pilot->sums->count == 0) return {};
  const Summary& sums = *pilot->sums;
  const double part =
      static_cast<double>(primaries) / static_cast<double>(sums.count * pilot->primaries);
  return PilotedCost{.rays = is_draw ? 0 : part * static_cast<double>(sums.cost.rays()),
                     .samples = part * static_cast<double>(sums.cost.samples),
                     .seconds = part * sums.seconds};
}

std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots) {
  Forecast found;
  if (test.plan.invalid.empty()) foresee(test, pilots, found);
  const double drawn = found.if_true ? found.if_true->drawn : 1;
  return static_cast<std::uint64_t>(
      std::ceil(drawn * static_cast<double>(test.plan.most_secondaries())));
}

}  // namespace assay::harness
