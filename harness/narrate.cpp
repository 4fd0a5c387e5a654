#include "harness/narrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/number.h"
#include "stats/tails.h"

namespace assay::harness {
namespace {

using reports::Verdict;

std::string p_text(double log_p) {
  return "p = " + reports::p_text(std::exp(log_p), log_p / std::log(10.0));
}

/// "0.31 %" without a sign; a ratio as the factor it is.
std::string size_text(double theta, const Evidence& evidence) {
  if (evidence.relative) return fmt::format("{:.3g} %", 100 * std::abs(theta));
  if (evidence.ratio) return fmt::format("a factor of {:.4g}", std::exp(std::abs(theta)));
  return fmt::format("{:.3g}", std::abs(theta));
}

std::string interval_text(const ChannelOutcome& channel, double confidence) {
  const stats::Interval interval = channel.evidence.interval(confidence);
  return fmt::format("[{}, {}] at {}", show_theta(interval.low, channel.evidence),
                     show_theta(interval.high, channel.evidence),
                     reports::confidence_text(confidence));
}

std::string in_channel(const TestOutcome& outcome, const ChannelOutcome& channel) {
  return outcome.question.channel_count() > 1 ? " in channel " + channel.name : "";
}

const ChannelOutcome& least_excluded(const TestOutcome& outcome) {
  return *std::max_element(outcome.channels.begin(), outcome.channels.end(),
                           [](const ChannelOutcome& a, const ChannelOutcome& b) {
                             return a.decision.log_p_forbidden < b.decision.log_p_forbidden;
                           });
}

/// The largest effect in the claim's forbidden direction that is not excluded at beta.
double excluded_beyond(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const stats::Interval interval = channel.evidence.interval(1 - 2 * outcome.share().beta);
  switch (channel.regions.relation) {
    case Relation::at_most:
    case Relation::less:
      return interval.high;
    case Relation::at_least:
    case Relation::greater:
      return interval.low;
    case Relation::equal:
    case Relation::within:
      break;
  }
  return std::max(std::abs(interval.low), std::abs(interval.high));
}

std::string passed_alarm(const TestOutcome& outcome, const ChannelOutcome& channel) {
  if (!channel.regions.has_forbidden()) {
    std::string text = "no evidence against the claim";
    if (channel.detectable) {
      text +=
          fmt::format("; {} or more would have been found with probability {:g}",
                      size_text(*channel.detectable, channel.evidence), 1 - outcome.share().beta);
    }
    return text;
  }
  const double excluded = excluded_beyond(outcome, channel);
  const std::string confidence = reports::confidence_text(1 - outcome.share().beta);
  const bool one_sided = !channel.regions.two_sided();
  const double towards = channel.regions.relation == Relation::at_least ? -excluded : excluded;
  if (one_sided && towards <= 0) {
    return fmt::format(
        "no evidence against the claim, which holds with {} to spare at {} confidence",
        size_text(excluded, channel.evidence), confidence);
  }
  return fmt::format("no evidence against the claim; {} or more is excluded at {} confidence",
                     size_text(excluded, channel.evidence), confidence);
}

std::string passed_proof(const TestOutcome& outcome, const ChannelOutcome& channel) {
  return fmt::format("shown: {} is {} {} ({})", channel.evidence.quantity,
                     show_theta(channel.evidence.estimate, channel.evidence),
                     interval_text(channel, 1 - 2 * outcome.share().beta),
                     p_text(channel.decision.log_p_forbidden) + " against the contrary");
}

std::string failed(const TestOutcome& outcome, const ChannelOutcome& channel) {
  if (channel.image) {
    return fmt::format(
        "differs most at {}, {}; {} is {} {}",
        place_text(channel.image->family.winner, *outcome.question.subjects[0].image),
        p_text(channel.decision.log_p_claimed), channel.evidence.quantity,
        show_theta(channel.evidence.estimate, channel.evidence),
        interval_text(channel, channel.effect.confidence));
  }
  return fmt::format("{} is {} {}{}, {}{}", channel.evidence.quantity,
                     show_theta(channel.evidence.estimate, channel.evidence),
                     interval_text(channel, channel.effect.confidence),
                     in_channel(outcome, channel), p_text(channel.decision.log_p_claimed),
                     channel.evidence.where);
}

/// In an alarm any estimate decides once the room between the margins holds a standard error
/// z_alpha and z_beta times; in a proof it decides by how far it lies from the forbidden region,
/// with one standard error to spare.
struct Room {
  double size = 0;
  double standard_errors = 1;  ///< that it must hold
};

Room room_of(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const auto z = [](double level) {
    return stats::normal_quantile({stats::Tail::upper, std::log(level)});
  };
  const Regions& regions = channel.regions;
  const ErrorShare share = outcome.share();
  const double estimate = channel.evidence.estimate;
  const double beyond = z(share.beta) + 1;
  switch (regions.relation) {
    case Relation::within:
      return {regions.within - std::abs(estimate), beyond};
    case Relation::less:
      return {-estimate, beyond};
    case Relation::greater:
      return {estimate, beyond};
    case Relation::equal:
    case Relation::at_most:
    case Relation::at_least:
      break;
  }
  const double alpha = regions.two_sided() ? share.alpha / 2 : share.alpha;
  return {regions.detect.value_or(0) - regions.allow, z(alpha) + z(share.beta)};
}

/// The standard error of the reference on theta's scale: what no number of samples takes away.
double reference_error(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const Question& question = outcome.question;
  if (question.kind != QuestionKind::mean_of_one) return 0;
  for (std::size_t i = 0; i < question.channel_count(); ++i) {
    if (question.channel_name(i) != channel.name) continue;
    const Constant& reference = question.references[i];
    const double unit = is_relative(question, i) ? std::abs(reference.value) : 1;
    return reference.standard_error / unit;
  }
  return 0;
}

/// n grows with the square of how much narrower the interval must become.
std::string what_would_decide(const TestOutcome& outcome, const ChannelOutcome& channel) {
  if (channel.image) {
    if (channel.image->wanted == 0) {
      return "the estimate lies where the claim must not pass, yet not clearly so";
    }
    return fmt::format("about {} images would decide if the estimate stands",
                       reports::human(channel.image->wanted, 2));
  }
  const double beta = outcome.share().beta;
  const stats::Interval interval = channel.evidence.interval(1 - 2 * beta);
  const double half = (interval.high - interval.low) / 2;
  const Room room = room_of(outcome, channel);
  if (!(half > 0) || !std::isfinite(half) || !(room.size > 0)) {
    return "the estimate lies where the claim must not pass, yet not clearly so";
  }
  const double z = stats::normal_quantile({stats::Tail::upper, std::log(beta)});
  // Half the interval is z standard errors; those of the samples must shrink to what the
  // reference's leaves of the room.
  const double fixed = reference_error(outcome, channel);
  const double sampled = half * half / (z * z) - fixed * fixed;
  const double wanted = std::pow(room.size / room.standard_errors, 2) - fixed * fixed;
  if (!(wanted > 0)) {
    return "no number of samples would decide: the reference's own error forbids it";
  }
  const double factor = std::max(0.0, sampled) / wanted;
  return fmt::format(
      "about {} secondaries would decide{}",
      reports::human(std::max(1.1, factor) * static_cast<double>(outcome.secondaries()), 2),
      channel.regions.proof() ? " if the estimate stands" : "");
}

std::string undecided(const TestOutcome& outcome, const ChannelOutcome& channel) {
  return fmt::format("{} is {} {}{}: neither shown nor refuted; {}", channel.evidence.quantity,
                     show_theta(channel.evidence.estimate, channel.evidence),
                     interval_text(channel, 1 - 2 * outcome.share().beta),
                     in_channel(outcome, channel), what_would_decide(outcome, channel));
}

}  // namespace

std::string show_theta(double theta, const Evidence& evidence) {
  if (evidence.relative) return fmt::format("{:+.3g} %", 100 * theta);
  if (evidence.ratio) return fmt::format("x {:.4g}", std::exp(theta));
  return fmt::format("{:.4g}", theta);
}

std::string narrate(const TestOutcome& outcome) {
  if (outcome.channels.empty()) return "";
  const ChannelOutcome& worst = outcome.channels.front();
  switch (outcome.verdict) {
    case Verdict::fail:
      return failed(outcome, worst);
    case Verdict::inconclusive:
      return undecided(outcome, least_excluded(outcome));
    case Verdict::pass:
      break;
    default:
      return "";
  }
  const ChannelOutcome& least = least_excluded(outcome);
  return least.regions.proof() ? passed_proof(outcome, least) : passed_alarm(outcome, least);
}

}  // namespace assay::harness
