#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/run/evaluate.h"
#include "harness/theta/ask.h"
#include "reports/words/describe.h"
#include "reports/words/number.h"
#include "reports/words/text.h"
#include "stats/images/image_family.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

using reports::Verdict;

std::string p_text(double log_p) {
  return reports::NamedP{"p", std::exp(log_p), log_p / std::log(10.0)}.text();
}

/// "difference from the reference is +0.31 % (99 % interval: +0.12 % to +0.5 %)".
std::string finding(const ChannelOutcome& channel) {
  const reports::Effect& effect = channel.effect;
  const std::string name = reports::effect_name(effect);
  if (effect.estimate) return fmt::format("{} is {}", name, reports::named_effect_text(effect));
  if (channel.image) return name;  // a law of images
  // An exponent of which only one point differs from zero.
  return fmt::format("{} is {}{}", name,
                     effect.relative ? "infinite, because it is relative to 0" : "no finite number",
                     reports::named_range_text(effect));
}

std::string in_channel(const TestOutcome& outcome, const ChannelOutcome& channel) {
  return outcome.question.channel_count() > 1 ? " in channel " + channel.name : "";
}

/// The theta that is shown as the larger. For ratios -14.3 % is shown as less than +16.2 %, though
/// their logarithms are equally far from 0.
double farther(double x, double y, bool ratio) {
  constexpr double near = std::numbers::ln2;
  const bool in_per_cent = ratio && std::abs(x) <= near && std::abs(y) <= near;
  const auto size = [&](double theta) { return std::abs(in_per_cent ? std::expm1(theta) : theta); };
  return size(x) > size(y) ? x : y;
}

/// The largest effect in the claim's forbidden direction inside the interval.
double excluded_beyond(const TestOutcome& outcome, const ChannelOutcome& channel) {
  // A missing end lies at infinity.
  const double low = channel.effect.low.value_or(-HUGE_VAL);
  const double high = channel.effect.high.value_or(HUGE_VAL);
  if (channel.regions.two_sided()) return farther(low, high, outcome.question.is().logarithm);
  return channel.regions.bounds_above() ? high : low;
}

/// An image's interval is that of the difference's size, and does not decide.
const char* no_evidence(const ChannelOutcome& channel) {
  return channel.image && channel.effect.low.value_or(0) > 0
             ? "no place differs beyond noise, but all pixels together do"
             : "no evidence against the claim";
}

/// The interval that decides a pass is narrower than the one at the test's share of alpha. It may
/// leave out the claimed value.
std::string evidence_against(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const double edge = channel.regions.claimed_edge();
  const bool above = channel.regions.bounds_above() && lies_above(channel.effect, edge);
  const bool below = channel.regions.bounds_below() && lies_below(channel.effect, -edge);
  if (channel.image || (!above && !below)) return no_evidence(channel);
  return fmt::format("not enough evidence against the claim, {} where its share of alpha is {:.2g}",
                     p_text(channel.decision.log_p_claimed), outcome.place.share.alpha);
}

std::string found_in_cell(const TestOutcome& outcome, const ChannelOutcome& channel) {
  if (!channel.image || !channel.image->detectable_in_cell) return "";
  const bool noisy = channel.effect.relative && *channel.image->detectable_in_cell > 1;
  return fmt::format(
      "; {1}{2} in one square of {0} x {0} pixels would have been found, too; {3}{4}",
      stats::typical_side, reports::margin_text(*channel.image->detectable_in_cell, channel.effect),
      channel.effect.relative ? " of the image's mean" : "",
      noisy ? "so much noise may come from a few bright samples" : "only means were compared",
      outcome.question.of_two() ? ": test the `distribution` too (--law)" : "");
}

std::string passed_alarm(const TestOutcome& outcome, const ChannelOutcome& channel) {
  if (channel.evidence.exact) return "as claimed: values that never vary need no test";
  if (!channel.regions.has_forbidden()) {
    const std::string text = no_evidence(channel);
    if (const std::string all = outcome.question.theta->not_excluded(channel); !all.empty()) {
      return fmt::format("{}; but {}: {}", text, excludes_no(all),
                         outcome.question.theta->how_to_exclude());
    }
    if (channel.detectable) {
      // Other cells see the same difference in a few pixels, or of both signs, from other sizes on.
      const char* how = channel.image ? " all over the image" : " or more";
      return fmt::format("{}; an error of {}{} would have been found with probability {:g}{}", text,
                         reports::margin_text(*channel.detectable, channel.effect), how,
                         1 - outcome.place.share.beta, found_in_cell(outcome, channel));
    }
    if (reports::range_text(channel.effect).empty()) return text;
    return fmt::format(
        "{}; there is no proof of it either: {}; say with `detect` how large an error must not "
        "pass",
        text, finding(channel));
  }
  // A distance's interval has ends, unless even 0 is too large for these data.
  const bool has_ends = channel.effect.low || channel.effect.high;
  if (channel.evidence.distance && !has_ends) {
    return fmt::format(
        "no evidence against the claim; {} or more is excluded, {}; the data lie closer to the "
        "claim than chance leads to expect, so that there is no {} interval",
        reports::margin_text(*channel.regions.detect, channel.effect),
        p_text(channel.decision.log_p_forbidden),
        reports::confidence_text(channel.effect.confidence));
  }
  const double excluded = excluded_beyond(outcome, channel);
  const std::string interval =
      fmt::format("the {} interval{}", reports::confidence_text(channel.effect.confidence),
                  in_channel(outcome, channel));
  const bool one_sided = !channel.regions.two_sided();
  const double towards = channel.regions.relation == Relation::at_least ? -excluded : excluded;
  if (one_sided && towards <= 0) {
    return fmt::format("no evidence against the claim, which holds with {} to spare by {}",
                       reports::size_text(excluded, channel.effect), interval);
  }
  return fmt::format("{}; {} or more{} is excluded by {}{}", evidence_against(outcome, channel),
                     reports::size_text(excluded, channel.effect),
                     channel.image ? " over the whole image" : "", interval,
                     found_in_cell(outcome, channel));
}

std::string passed_proof(const TestOutcome& outcome, const ChannelOutcome& channel) {
  return fmt::format("shown: {}{}, {} if the claim were wrong", finding(channel),
                     in_channel(outcome, channel), p_text(channel.decision.log_p_forbidden));
}

Reason failed(const TestOutcome& outcome, const ChannelOutcome& channel) {
  if (is_told_by_place(outcome, channel)) {
    const stats::ImageFamily& family = channel.image->family;
    const auto [place, size] =
        place_text(family.winner, *outcome.question.subjects[0].image, family.weights);
    return fmt::format("differs most at {}{}, {}; {}{}", place, size,
                       p_text(channel.decision.log_p_claimed),
                       channel.effect.estimate ? "over all pixels the " : "", finding(channel));
  }
  const std::string text = fmt::format("{}{}, {}", finding(channel), in_channel(outcome, channel),
                                       p_text(channel.decision.log_p_claimed));
  const auto& most_against = channel.evidence.most_against;
  const std::string place = most_against ? most_against(channel.regions.claimed_edge()) : "";
  return place.empty() ? Reason(text) : Reason::advising(text + "; ", place);
}

ErrorShare last_levels(const TestOutcome& outcome) {
  return outcome.share_at(outcome.plan.looks.count() - 1);
}

/// The room between margins in standard errors. An alarm needs z_alpha and z_beta of them, then any
/// estimate decides. A proof needs the estimate's distance from the border of the claim, and two to
/// spare: fresh data give another estimate.
struct Room {
  double size = 0;
  double standard_errors = 1;  ///< the room must hold so many
  bool outside = false;        ///< of what must be proved
};

Room room_of(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const auto z = stats::upper_normal_quantile;
  const Regions& regions = channel.regions;
  const ErrorShare share = last_levels(outcome);
  const double estimate = channel.evidence.estimate;
  const auto proof = [&](double spare) {
    return Room{std::abs(spare), z(spare < 0 ? share.alpha : share.beta) + 2, spare < 0};
  };
  if (regions.within()) return proof(*regions.detect - std::abs(estimate));
  if (regions.proof()) return proof(regions.bounds_above() ? -estimate : estimate);
  const double alpha = regions.two_sided() ? share.alpha / 2 : share.alpha;
  return {regions.detect.value_or(0) - regions.allow, z(alpha) + z(share.beta)};
}

/// The reference's standard error on theta's scale, which no number of samples reduces.
double reference_error(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const Question& question = outcome.question;
  if (question.references.size() != question.channel_count()) return 0;
  const Constant& reference = question.references[channel.index];
  return reference.standard_error / unit_of_theta(question, channel.index, 0);
}

/// Half the interval in standard errors if each end errs with `tail`. With few observations t is
/// far wider than the normal law of a larger sample.
double interval_errors(const ChannelOutcome& channel, double tail) {
  const stats::LogTail beyond{stats::Tail::upper, std::log(tail)};
  const stats::Distribution law = channel.evidence.at(channel.evidence.estimate).distribution;
  return law.family == "student-t" ? stats::student_t_quantile(beyond, law.parameters.at(0))
                                   : stats::normal_quantile(beyond);
}

/// So many times the observations would decide.
Reason with_more(const TestOutcome& outcome, double factor, const std::string& condition = "") {
  if (has_rows(outcome.question)) {
    const std::string sizes = sizes_text(outcome, factor);
    const bool differ = sizes.find(' ') != std::string::npos;  // N and M
    return Reason::advising("",
                            fmt::format("give about {} {}{}", sizes, rows_noun(outcome.question),
                                        differ                      ? ""
                                        : outcome.question.of_two() ? " a side"
                                                                    : " in all") +
                                condition);
  }
  return more_drawn(outcome, factor, "would decide" + condition);
}

/// n grows with the square of the factor by which the interval must shrink.
Reason what_would_decide(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const char* condition = channel.regions.proof() ? " if the truth is what was seen" : "";
  if (channel.image && channel.image->wanted > 0) {
    const auto replicates = static_cast<double>(channel.image->replicates);
    return with_more(outcome, channel.image->wanted / replicates, condition);
  }
  const double beta = last_levels(outcome).beta;
  const stats::Interval interval = channel.evidence.interval(1 - 2 * beta);
  const double half = (interval.high - interval.low) / 2;
  const Room room = room_of(outcome, channel);
  if (!(half > 0) || !std::isfinite(half) || !(room.size > 0)) {
    return Reason("these observations do not show how many would decide");
  }
  // The samples' standard errors must shrink to the room that the reference's leaves.
  const double fixed = reference_error(outcome, channel);
  const double error = half / interval_errors(channel, beta);
  const double sampled = std::max(0.0, error * error - fixed * fixed);
  // It is infinite where the reference's own error is too large.
  const auto factor = [&](double size) {
    const double wanted = std::pow(size / room.standard_errors, 2) - fixed * fixed;
    return wanted > 0 ? std::max(1.1, sampled / wanted) : HUGE_VAL;
  };
  if (channel.regions.proof() && room.size < error) {
    const std::string where =
        fmt::format("the estimate {} the claim by less than a standard error; ",
                    room.outside ? "misses" : "meets");
    if (!channel.regions.within()) {
      const std::string more = has_rows(outcome.question)      ? rows_noun(outcome.question)
                               : outcome.question.test->budget ? "`budget`"
                                                               : "observations";
      return Reason::advising(
          where,
          "if both sides may be equal, claim `within` a margin; otherwise give more " + more);
    }
    if (const double exact = factor(*channel.regions.detect); std::isfinite(exact)) {
      Reason more = with_more(outcome, exact, " if the claim holds exactly");
      more.text = where + more.text;
      return more;
    }
  }
  const double more = factor(room.size);
  if (std::isfinite(more)) return with_more(outcome, more, condition);
  return Reason("no number of observations would decide: the reference's own error is too large");
}

Reason undecided(const TestOutcome& outcome, const ChannelOutcome& channel) {
  Reason reason = what_would_decide(outcome, channel);
  const bool allows = !outcome.plan.row_allowances.empty();
  reason.text = fmt::format(
      "{}{}: neither shown nor refuted; {}{}", finding(channel), in_channel(outcome, channel),
      allows
          ? "the interval is wider because successive rows look correlated, which may be chance; "
          : "",
      reason.text);
  return reason;
}

}  // namespace

std::string excludes_no(const std::string& what) {
  return fmt::format("these observations rule out no {} at all", what);
}

Reason narrate(const TestOutcome& outcome) {
  if (outcome.channels.empty()) return {};
  const ChannelOutcome& least = *std::ranges::max_element(
      outcome.channels, {},
      [](const ChannelOutcome& channel) { return channel.decision.log_p_forbidden; });
  Reason reason;
  if (outcome.verdict == Verdict::fail) reason = failed(outcome, outcome.channels.front());
  if (outcome.verdict == Verdict::inconclusive) reason = undecided(outcome, least);
  if (outcome.verdict == Verdict::pass)
    reason = least.regions.proof() ? passed_proof(outcome, least) : passed_alarm(outcome, least);
  const std::string& doubt = outcome.plan.caution;
  if (outcome.verdict != Verdict::fail && !doubt.empty()) reason.text += "; " + doubt;
  reason.text = reports::plain_spaces(reason.text);
  return reason;
}

}  // namespace assay::harness
