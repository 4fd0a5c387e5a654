#include "harness/run/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "estimators/core/quoting.h"
#include "harness/base/numbers.h"
#include "harness/draws/sampler_setup.h"
#include "harness/plan/plan.h"
#include "reports/words/number.h"

namespace assay::harness {
namespace {

using reports::Verdict;

/// The command that repeats one observation; "" of a claim in a test binary.
std::string replay_line(const TestOutcome& outcome, std::uint64_t observation) {
  if (outcome.question.test->where.file.empty()) return "";
  return fmt::format("; until the next run from here, `assay replay {} {}` draws it again",
                     shell_quoted(outcome.question.test->id), observation);
}

std::string not_finite(const TestOutcome& outcome, const Subject& side, const Drawn& drawn,
                       std::size_t channel) {
  const ChannelSummary& summary = drawn.summary().channels[channel];
  const Pool& pool = drawn.pool();
  const auto at = side.image ? " at " + element_place(*side.setup->image(), channel) : "";
  const auto place = side.setup->place_of(
      {.index = summary.first_nonfinite, .key = pool.key(), .primaries = pool.primaries()});
  // Whoever wrote a file finds its line, not a number of an observation.
  const std::string number = fmt::format("observation {}", summary.first_nonfinite);
  const std::string first = place.empty()
                                ? number + replay_line(outcome, summary.first_nonfinite)
                                : (is_recorded(side) ? "" : number + ", ") + "`" + place + "`";
  const std::string text =
      fmt::format("{} of {} observations of `{}`{} {} not finite, the first is {}",
                  summary.nonfinite, drawn.summary().count, side.estimator->name, at,
                  summary.nonfinite == 1 ? "is" : "are", first);
  if (place.empty()) return text;
  if (!side.image) return text + "; mend it; leaving it out would bias a mean";
  std::set<std::size_t> pixels;
  for (const std::size_t element : side.channels.all()) {
    if (drawn.summary().channels[element].nonfinite > 0)
      pixels.insert(element / side.image->components.size());
  }
  return fmt::format("{}; {} of {} pixels {} not finite in some picture{}", text, pixels.size(),
                     side.image->pixels(), pixels.size() == 1 ? "is" : "are", leave_out_nonfinite);
}

/// The sampler of that name, or the only one.
std::shared_ptr<const Sampler> sampler_of(const Setup& setup, const std::string& name) {
  const std::vector<NamedSampler> all = setup.samplers();
  const auto named = std::ranges::find(all, name, &NamedSampler::name);
  if (named != all.end()) return named->sampler;
  return all.size() == 1 ? all[0].sampler : nullptr;
}

bool draws_differ(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  const auto& setup = dynamic_cast<const SamplerSetup&>(*subject.setup);
  const auto original = sampler_of(*subject.estimator->original, setup.name());
  if (original == nullptr) return true;
  for (std::uint64_t i = 0; i < observations; ++i) {
    // It has all digits, and says the same of numbers that are none.
    if (draw_text(setup.sampler(), pool.key(), i) != draw_text(*original, pool.key(), i)) {
      return true;
    }
  }
  return false;
}

bool estimates_differ(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  const Setup& original = *subject.estimator->original;
  const std::size_t channels = original.channel_count();
  if (subject.setup->channel_count() != channels) return true;
  for (std::size_t i = 0; i < channels; ++i) {
    if (subject.setup->channel(i).mean != original.channel(i).mean) return true;
  }
  const std::unique_ptr<Estimator> one = subject.setup->make();
  const std::unique_ptr<Estimator> other = original.make();
  const KeptObservations& kept = *pool.kept();
  std::vector<double> a(channels);
  std::vector<double> b(channels);
  for (std::uint64_t i = 0; i < observations; ++i) {
    if (i < kept.size()) {
      kept.whole(i, a);
    } else {
      pool.draw_again(*one, i, a);
    }
    pool.draw_again(*other, i, b);
    if (a != b) return true;
  }
  return false;
}

/// Why a test's observations cannot be judged: not finite, or outside their declared range; "" if
/// they can.
std::string unusable(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    const Subject& side = outcome.question.subjects[subject];
    const Summary& drawn = test.samples[subject].summary();
    if (drawn.elements) continue;  // all finite
    for (const std::size_t channel : side.channels.all()) {
      if (drawn.channels[channel].nonfinite == 0) continue;
      return not_finite(outcome, side, test.samples[subject], channel);
    }
    if (std::string fault = outside_of_range(side, drawn); !fault.empty()) return fault;
  }
  return "";
}

/// True if a mutant's defect changed something: an observation of the pool differs from its
/// original's on the same stream. Declarations count too: another analytic mean or density. True
/// for an estimator that is no mutant.
bool was_activated(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  if (!subject.estimator->original) return true;
  return subject.purpose.empty() ? estimates_differ(subject, pool, observations)
                                 : draws_differ(subject, pool, observations);
}

/// The look for which detectable effect and power are quoted: the last, or where a budget ended.
std::size_t quoted_look(const TestOutcome& outcome) {
  const bool ended = outcome.verdict == Verdict::inconclusive;
  return ended ? outcome.look : outcome.plan.looks.count() - 1;
}

/// Error of the interval whose ends decide: two tests at beta, or one or two tails at alpha. Where
/// neither has decided it is the smaller one.
double deciding_error(const TestOutcome& outcome, const ChannelOutcome& channel,
                      const ErrorShare& share) {
  const bool two_tails = channel.regions.two_sided() && !channel.evidence.distance;
  const double refuting = (two_tails ? 1 : 2) * share.alpha;
  if (outcome.verdict == Verdict::fail || !channel.regions.has_forbidden()) return refuting;
  const double excluding = 2 * share.beta;
  return outcome.verdict == Verdict::pass ? excluding : std::min(refuting, excluding);
}

/// The effect with the interval behind the verdict. Its ends are at this look's levels, so it holds
/// theta with the confidence shown wherever sampling stops (repeated confidence interval). A fail
/// shows the interval at alpha, which misses the claimed region. A pass that excludes the forbidden
/// region shows the interval at 1 - 2 beta: one test at beta to each side. That of an undecided
/// test is the wider one: it meets the claimed region and the forbidden one.
reports::Effect effect_of(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const Evidence& evidence = channel.evidence;
  // A smaller error is lost in 1 - error. A narrower interval shows the same verdict.
  constexpr double least_error = 1e-12;
  const double error = std::max(deciding_error(outcome, channel, outcome.share()), least_error);
  const stats::Interval interval = evidence.interval(1 - error);
  std::string quantity = evidence.quantity;
  // With a factor the effect is relative to factor * second.
  if (const double factor = outcome.question.factor; factor != 1)
    quantity += fmt::format(" (the second times {:g})", factor);
  return {.quantity = outcome.question.is().logarithm ? "ln(" + quantity + ")" : quantity,
          .estimate = number(evidence.estimate),
          .low = number(interval.low),
          .high = number(interval.high),
          .confidence = 1 - deciding_error(outcome, channel, outcome.place.share),
          .relative = evidence.relative};
}

void note_sizes(TestOutcome& outcome, const DrawnTest& test) {
  for (ChannelOutcome& channel : outcome.channels) {
    channel.effect = effect_of(outcome, channel);
    if (channel.image) {
      note_detectable(outcome, quoted_look(outcome), channel);
      continue;
    }
    const std::vector<ChannelData> data = data_of(test, channel.index);
    const Theta& theta = *outcome.question.theta;
    PlannedChannel observed =
        theta.observed({outcome.question, channel.index, data}, channel.regions);
    if (outcome.plan.method.is.of_batches) {
      // The deviations of independent values whose means are as uncertain.
      for (std::size_t subject = 0; subject < data.size(); ++subject) {
        observed.deviations[subject] =
            outcome.question.factor_of(subject) *
            (std::sqrt(static_cast<double>(outcome.secondaries(subject))) *
             data[subject].moments.standard_error());
      }
    }
    const Sized sized{outcome, quoted_look(outcome), observed};
    const bool equivalence = channel.regions.within();
    if (!equivalence) channel.detectable = detectable_effect(sized);
    if (!equivalence && !channel.regions.detect) continue;
    const auto power = theta.power(sized, equivalence ? 0 : *channel.regions.detect);
    if (power) outcome.power = std::min(*power, outcome.power.value_or(1));
  }
}

void settle(TestOutcome& outcome, Verdict verdict, Reason reason) {
  outcome.verdict = verdict;
  outcome.message = std::move(reason.text);
  outcome.advice = std::move(reason.advice);
}

ChannelOutcome channel_outcome(const DrawnTest& test, const Seen& seen) {
  const Theta& theta = *seen.question.theta;
  const Regions& regions = test.outcome.plan.regions[seen.channel];
  ChannelEvidence found = theta.evidence(test, seen);
  const stats::TestResult at_null = found.evidence.at(0);
  const ChannelDecision decision{.log_p_claimed = log_p_claimed(found.evidence, regions),
                                 .log_p_forbidden = log_p_forbidden(found.evidence, regions)};
  return {.index = seen.channel,
          .name = seen.question.channel_name(seen.channel),
          .regions = regions,
          .at_null = at_null,
          .evidence = std::move(found.evidence),
          .decision = decision,
          .finds_nothing =
              !regions.has_forbidden() &&
              theta.finds_nothing({test.outcome, test.outcome.look, theta.observed(seen, regions)}),
          .reference = theta.marked(seen),
          .image = std::move(found.image)};
}

int badness(Verdict verdict) {
  constexpr Verdict worse[] = {Verdict::inconclusive, Verdict::invalid, Verdict::fail,
                               Verdict::error};
  const auto* const at = std::ranges::find(worse, verdict);
  return at == std::end(worse) ? 0 : static_cast<int>(at - worse) + 1;
}

/// Computes numbers and gates of every channel at the current look. Returns the verdicts of
/// constant channels.
std::vector<ConstantVerdict> evaluate_channels(TestOutcome& outcome, const DrawnTest& test) {
  const Question& question = outcome.question;
  std::vector<ConstantVerdict> constants;
  const double part = outcome.place.share.alpha / static_cast<double>(outcome.plan.looks.count());
  const double critical = critical_value(std::max(outcome.share().alpha, part),
                                         is_two_sided(question.test->claim.relation));
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const std::vector<ChannelData> data = data_of(test, channel);
    const Seen seen{question, channel, data};
    if (std::optional<ConstantVerdict> constant = question.theta->settled(outcome, seen)) {
      if (question.channel_count() > 1) {
        constant->message = question.channel_name(channel) + ": " + constant->message;
      }
      constants.push_back(*std::move(constant));
      continue;
    }
    std::ranges::move(question.theta->gates(outcome, seen, critical),
                      std::back_inserter(outcome.gates));
    outcome.channels.push_back(channel_outcome(test, seen));
  }
  return constants;
}

/// Adds the look's p-values to those of all looks, or nothing if it does not count.
void remember(TestOutcome& outcome, bool counts) {
  outcome.history.resize(outcome.question.channel_count());
  for (ChannelHistory& history : outcome.history) {
    history.log_p_claimed.push_back(0);
    history.log_p_forbidden.push_back(0);
    history.effect.emplace_back();
  }
  for (ChannelOutcome& channel : outcome.channels) {
    ChannelHistory& history = outcome.history[channel.index];
    if (counts) {
      history.log_p_claimed.back() = channel.decision.log_p_claimed;
      history.log_p_forbidden.back() = channel.decision.log_p_forbidden;
      history.effect.back() = reports::Effect{.estimate = number(channel.evidence.estimate),
                                              .relative = channel.evidence.relative};
    }
    channel.decision = {.log_p_claimed = stats::log_p_over_looks(
                            outcome.plan.looks, history.log_p_claimed, channel.regions.two_sided()),
                        .log_p_forbidden = stats::log_p_over_looks(outcome.plan.looks,
                                                                   history.log_p_forbidden, false)};
    channel.decision.rejected =
        channel.decision.log_p_claimed <= std::log(outcome.place.share.alpha);
  }
  std::ranges::stable_sort(outcome.channels, {}, [](const ChannelOutcome& channel) {
    return channel.decision.log_p_claimed;
  });
}

/// Points on no power law reject every slope, which says nothing about any, whatever the method.
bool passes_without_fit(const TestOutcome& outcome) {
  return outcome.question.is().fit_decides && outcome.verdict == Verdict::pass &&
         outcome.plan.regions[0].has_forbidden() && !red_gates(outcome.gates).empty();
}

/// Says why the test passes by not failing, which says nothing: it finds no error that is possible,
/// or its interval excludes none. "" if it could have failed, or shows the claim.
std::string cannot_fail(const TestOutcome& outcome) {
  for (ChannelOutcome channel : outcome.channels) {
    // Other intervals have ends, and cost time.
    if (!channel.finds_nothing && !outcome.question.is().may_be_unbounded) continue;
    const Regions& regions = channel.regions;
    channel.effect = effect_of(outcome, channel);
    const auto& [low, high] = std::pair(channel.effect.low, channel.effect.high);
    if (channel.finds_nothing) {
      const stats::Range claimed = regions.claimed();
      const bool is_shown =
          low.value_or(-HUGE_VAL) >= claimed.low && high.value_or(HUGE_VAL) <= claimed.high;
      if (is_shown) continue;
      return fmt::format("{} observations are too few to find any error that the range allows",
                         outcome.secondaries());
    }
    const std::string what = outcome.question.theta->not_excluded(channel);
    const bool by_large = regions.bounds_above() && low;
    const bool by_small = regions.bounds_below() && high;
    if (!what.empty() && !by_large && !by_small) return excludes_no(what);
  }
  return "";
}

void conclude(TestOutcome& outcome, const std::vector<ConstantVerdict>& constants) {
  // A forced method only shows its gates.
  const std::string red = outcome.question.test->method ? "" : red_gates(outcome.gates);
  remember(outcome, red.empty());
  if (!outcome.plan.invalid.empty()) {
    settle(outcome, Verdict::invalid, outcome.plan.invalid);
    return;
  }
  if (!red.empty()) {
    Reason reason = what_would_help(outcome);
    reason.text = red + reason.text;
    settle(outcome, need_more(outcome.gates) ? Verdict::inconclusive : Verdict::invalid,
           std::move(reason));
    return;
  }
  const auto decisions = mapped(outcome.channels, &ChannelOutcome::decision);
  const double beta = outcome.place.share.beta;
  settle(outcome,
         decisions.empty() ? Verdict::pass : decide(decisions, outcome.plan.regions[0], beta), {});
  if (outcome.verdict == Verdict::pass && !outcome.plan.regions[0].has_forbidden()) {
    if (const std::string why = cannot_fail(outcome); !why.empty()) {
      settle(outcome, Verdict::inconclusive,
             Reason::advising(why + ": ", outcome.question.theta->how_to_exclude()));
    }
  }
  if (passes_without_fit(outcome)) settle(outcome, Verdict::invalid, red_gates(outcome.gates));
  for (const ConstantVerdict& constant : constants) {
    const bool says_all = outcome.channels.empty() && outcome.message.empty();
    if (says_all || badness(constant.verdict) > badness(outcome.verdict)) {
      settle(outcome, constant.verdict, constant.message);
    }
  }
}

void require_activation(TestOutcome& outcome, const DrawnTest& test) {
  // A plan that is invalid draws little, and has its own reason.
  if (outcome.question.test->expect != reports::Verdict::fail || !outcome.plan.invalid.empty())
    return;
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    if (was_activated(outcome.question.subjects[subject], test.samples[subject].pool(),
                      outcome.secondaries(subject))) {
      continue;
    }
    settle(outcome, Verdict::invalid,
           fmt::format("never activated: `{}` drew the same numbers as its original in all {} "
                       "observations",
                       outcome.question.subjects[subject].estimator->name,
                       outcome.secondaries(subject)));
  }
}

void clear_numbers(TestOutcome& outcome) {
  outcome.channels.clear();
  outcome.gates.clear();
  outcome.power.reset();
}

void judge(TestOutcome& outcome, const DrawnTest& test) {
  try {
    conclude(outcome, evaluate_channels(outcome, test));
  } catch (const std::domain_error& error) {
    // stats cannot test these data: no spread, too few cells.
    outcome.channels.clear();
    remember(outcome, false);
    settle(outcome, Verdict::invalid,
           outcome.plan.invalid.empty() ? Reason(in_words(error)) : outcome.plan.invalid);
  }
}

/// The observations of this look in equal runs of whole blocks.
std::vector<Replicate> replicates_of(const DrawnTest& test, std::size_t subject,
                                     std::size_t channel) {
  const std::uint64_t size = test.outcome.secondaries(subject) / replicate_count;
  std::vector<Replicate> replicates(1);
  for (const Summary& block : test.samples[subject].blocks()) {
    if (replicates.back().count >= size) replicates.emplace_back();
    if (replicates.size() > replicate_count) break;
    replicates.back().count += block.count;
    replicates.back().moments.merge(block.moments(channel));
    replicates.back().seconds += block.seconds;
  }
  replicates.resize(replicate_count);
  return replicates;
}

/// True if no look was sound and the last will be taken again at a larger size.
bool is_put_off(const TestOutcome& outcome) {
  const bool all_void = std::ranges::all_of(outcome.history, [](const ChannelHistory& history) {
    return std::ranges::none_of(history.effect,
                                [](const auto& effect) { return effect.has_value(); });
  });
  return !outcome.plan.postponed.empty() && !outcome.question.test->method && all_void &&
         need_more(outcome.gates) && !red_gates(outcome.gates).empty();
}

/// True if the claim fails, or passes as an equality with an interval that excludes it.
bool is_doubted(const TestOutcome& outcome) {
  if (outcome.verdict != Verdict::pass) return outcome.verdict == Verdict::fail;
  const reports::Effect& effect = outcome.channels[0].effect;
  return outcome.question.test->claim.relation == Relation::equal &&
         (lies_above(effect, 0) || lies_below(effect, 0));
}

void take_sound_look(TestWork& work, const DrawnTest& test, bool may_go_on) {
  TestOutcome& outcome = work.outcome;
  // A dependence that the pilot did not show is no plan's to mend.
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    judge_order(outcome.question.subjects[subject], test.samples[subject], outcome.gates,
                outcome.plan.invalid);
  }
  judge(outcome, test);
  const bool last =
      outcome.look == work.last_look || outcome.look + 1 == outcome.plan.looks.count();
  const bool settled = outcome.verdict == Verdict::fail || outcome.verdict == Verdict::pass;
  const bool goes_on = last ? is_put_off(outcome) : !settled;
  if (may_go_on && goes_on && outcome.plan.invalid.empty()) {
    outcome.decided = false;
    return;
  }
  if (!work.verdict_only) {
    note_sizes(outcome, test);
    if (outcome.message.empty()) {
      Reason reason = narrate(outcome);
      outcome.message = reason.text + where_it_differs(test);
      outcome.advice = std::move(reason.advice);
      const std::string caveat = is_doubted(outcome) ? outcome.question.theta->caveat(test) : "";
      if (!caveat.empty()) outcome.message += "; " + caveat;
      if (!caveat.empty() && outcome.verdict == Verdict::fail)
        outcome.advice = reports::Advice{.words = caveat};
    }
  }
  require_activation(outcome, test);
}

/// The reason why the look cannot be taken; nullopt if it was.
std::optional<std::string> take_drawn_look(TestWork& work, bool may_go_on) {
  if (!work.outcome.plan.error.empty()) return work.outcome.plan.error;
  std::string why;
  const std::optional<DrawnTest> test = drawn(work, &why);
  if (test) why = unusable(*test);
  if (!why.empty()) return why;
  if (!work.outcome.plan.pilot_error.empty()) return work.outcome.plan.pilot_error;
  take_sound_look(work, *test, may_go_on);
  return std::nullopt;
}

}  // namespace

std::string first_contradiction(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  if (outcome.verdict != reports::Verdict::fail) return "";
  std::optional<std::pair<std::uint64_t, std::string>> first;
  try {
    first = first_inconsistent(test.samples[0].pool(), outcome.secondaries());
  } catch (...) {
    // It is found by drawing again, which may fail: a program that ends meanwhile takes no verdict
    // with it.
  }
  if (!first) return "";
  return fmt::format("{}, first at observation {}{}", first->second, first->first,
                     replay_line(outcome, first->first));
}

Sample TestWork::sample(std::size_t subject) const {
  return pools[subject]->sample(outcome.secondaries(subject));
}

std::optional<DrawnTest> drawn(const TestWork& work, std::string* why) {
  DrawnTest test{.outcome = work.outcome};
  for (std::size_t subject = 0; subject < work.pools.size(); ++subject) {
    const Sample sample = work.sample(subject);
    if (const Fault* const fault = std::get_if<Fault>(&sample)) {
      if (why != nullptr) *why = sentence_of(*fault, work.outcome.question.subjects[subject]);
      return std::nullopt;
    }
    test.samples.push_back(std::get<Drawn>(sample));
  }
  return test;
}

std::vector<ChannelData> data_of(const DrawnTest& test, std::size_t channel) {
  std::vector<ChannelData> data;
  const Plan& plan = test.outcome.plan;
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    const Drawn& sample = test.samples[subject];
    const ChannelList& channels = test.outcome.question.subjects[subject].channels;
    const std::size_t index = channels[channel];
    const Summary& summary = sample.summary();
    const std::span<const double> values = sample.values(index);
    data.push_back({.primaries = plan.primaries[subject],
                    .moments = as_tested(plan, subject, channel, values, summary.moments(index)),
                    .values = values,
                    .cells = summary.details(index).cells,
                    .joint = powers_of(plan.method.keeps) == Powers::none
                                 ? std::vector<stats::JointMoments>()
                                 : joint_moments(summary.details(index)),
                    .group_variances = summary.group_variances});
    if (plan.method.keeps == Keeps::points) {
      data.back().sampled_cells = plan.cells;
      for (const std::size_t each : channels.all())
        data.back().all_values.push_back(sample.values(each));
    }
    if (plan.method.keeps == Keeps::images) data.back().images = {sample.images(), channels};
    if (plan.method.keeps == Keeps::blocks) {
      data.back().replicates = replicates_of(test, subject, index);
    }
  }
  return data;
}

void take_look(TestWork& work, bool may_go_on) {
  TestOutcome& outcome = work.outcome;
  outcome.decided = true;
  clear_numbers(outcome);
  std::optional<std::string> why;
  try {
    why = take_drawn_look(work, may_go_on);
  } catch (const NoDensity& failure) {
    why = lack_of_density(outcome.question, failure);
  } catch (const std::domain_error& error) {
    // A defect of this program stops this test and no other.
    why = fmt::format("internal error: {}", error.what());
  } catch (...) {
    // Judging asks some sources again: for densities, and for a mutant's original.
    why = words_of(std::current_exception());
  }
  if (!why) return;
  clear_numbers(outcome);
  settle(outcome, Verdict::error, *std::move(why));
}

}  // namespace assay::harness
