#include <fmt/format.h>

#include <algorithm>

#include "harness/families/families.h"
#include "harness/run/evaluate.h"
#include "harness/sampling/summary.h"
#include "harness/theta/ask.h"

namespace assay::harness {

const ThetaTraits& Question::is() const { return theta->is; }

bool Seen::relative() const { return question.theta->is_relative(question, channel); }

std::string Question::channel_name(std::size_t channel) const {
  return theta->channel_name(*this, channel);
}

Question Theta::bind(const TestEntry& test, const Estimators& estimators) const {
  const Claim& claim = test.claim;
  Question question{
      .test = &test, .theta = this, .subjects = {estimates(claim.left.source, estimators)}};
  if (const ScaledQuantity* other = other_side(claim)) {
    question.factor = other->factor;
    question.subjects.push_back(estimates(other->quantity.source, estimators));
  } else {
    // The claim's number, or what the plugin knows of each channel.
    const auto* const number = std::get_if<Constant>(&claim.right);
    question.references = mapped(question.subjects[0].declared(), [&](const Channel& channel) {
      return number != nullptr ? *number : analytic(claim.left, channel);
    });
  }
  return question;
}

std::string Theta::channel_name(const Question& question, std::size_t channel) const {
  return question.subjects[0].declared(channel).name;
}

std::string Theta::claimed_value(const Question& question, std::size_t channel) const {
  const Claim& claim = question.test->claim;
  if (const ScaledQuantity* const other = other_side(claim)) return to_string(*other);
  const auto* const number = std::get_if<Constant>(&claim.right);
  return fmt::format("{}", number != nullptr ? number->value : question.references[channel].value);
}

void Theta::check_margin(const Question& question, const Margin& margin) const {
  if (is.absolute != nullptr) require_absolute(margin, is.absolute);
  for (const Constant& reference : question.references) {
    if (reference.value == 0) require_absolute(margin, "the reference is zero");
  }
}

double Theta::known_size(const Question& question, const Pilots*) const {
  double largest = 0;
  if (is.absolute != nullptr) return largest;
  for (std::size_t i = 0; i < question.references.size(); ++i) {
    const Constant& reference = question.references[i];
    const double rounding = question.subjects[0].declared(is.joins_channels ? 0 : i).rounding;
    const double error = std::max(reference.standard_error, rounding);
    largest = std::max(largest, size_beyond_error(reference.value, error));
  }
  return largest;
}

std::uint64_t Theta::choose(TestOutcome&, const Pilots&) const { return least_secondaries; }

std::optional<std::uint64_t> Theta::secondaries(const TestOutcome& test, const ErrorShare& share,
                                                const Pilots& pilots) const {
  std::optional<std::uint64_t> most;
  if (!all_piloted(test.question, pilots)) return most;
  for (std::size_t channel = 0; channel < test.question.channel_count(); ++channel) {
    const Regions& regions = test.plan.regions[channel];
    if (!regions.detect) continue;
    const auto count = secondaries_of(test, channel, planned_rates(share, regions), pilots);
    if (!count) continue;
    most = std::max(most.value_or(least_secondaries), std::min(*count, impossible_secondaries));
  }
  return most;
}

std::string Theta::why_impossible(const Question& question) const {
  const bool uncertain = std::ranges::any_of(
      question.references, [](const Constant& each) { return each.standard_error > 0; });
  return uncertain
             ? "no number of observations would decide this claim: the reference's own standard "
               "error is too large for the margin; give a larger margin or a better reference"
             : "this claim would take more observations than can be counted; give a larger margin";
}

std::optional<PlannedChannel> Theta::planned(const TestOutcome& test, std::size_t channel,
                                             const Pilots&) const {
  return PlannedChannel{.regions = test.plan.regions[channel]};
}

std::optional<double> Theta::detectable(const Sized& sized) const {
  if (!sized.channel.varies()) return std::nullopt;
  double most = 0;
  for (const int side : sized.channel.regions.sides()) {
    most = std::max(most, stats::student_t_detectable(mean_plan(sized, side), sized.sizes().x));
  }
  return most / sized.channel.unit;
}

std::optional<double> Theta::power(const Sized& sized, double effect) const {
  const PlannedChannel& channel = sized.channel;
  if (!channel.varies()) return std::nullopt;
  const bool within = channel.regions.within();
  const double theta = (within ? *channel.regions.detect : effect) * channel.unit;
  double least = 1, missed = 0;
  for (const int side : channel.regions.sides()) {
    const double found = stats::student_t_power(mean_plan(sized, side), sized.sizes().x, theta);
    least = std::min(least, found);
    missed += 1 - found;
  }
  return within ? std::max(0.0, 1 - missed) : least;
}

std::optional<ConstantVerdict> Theta::settled(const TestOutcome&, const Seen& seen) const {
  for (std::size_t i = 0; i < seen.data.size() && !is.of_single_values; ++i) {
    if (is_constant(seen, i)) continue;
    const std::string& name = seen.question.subjects[i].estimator->name;
    std::string reason = beyond_doubles(seen.moments(i), name);
    for (const stats::JointMoments& powers : seen.data[i].joint) {
      if (reason.empty()) reason = beyond_doubles(powers, name);
    }
    if (!reason.empty()) return invalid(reason);
  }
  return std::nullopt;
}

ChannelEvidence Theta::evidence(const DrawnTest& test, const Seen& seen) const {
  return {.evidence = test.outcome.plan.method.evidence(seen)};
}

std::vector<Known> known_channels(const TestOutcome& test, const Pilots& pilots) {
  const Question& question = test.question;
  std::vector<Known> all;
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* pilot = pilot_of(side, pilots);
    if (pilot == nullptr || !side.purpose.empty()) continue;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      ChannelData data = pilot_channel(side, *pilot, channel);
      if (is_constant(side, channel, data.moments)) continue;
      all.push_back({.subject = subject,
                     .channel = channel,
                     .pilot = std::move(data),
                     .averaged = side.averaged(test.plan.primaries[subject]),
                     .rows = side.setup->observations().has_value(),
                     .label = ", pilot of " + side.name_of(channel)});
    }
  }
  return all;
}

void note(Plan& plan, const Known& known, const stats::Gate& gate) {
  if (!known.rows) plan.gates.push_back(gate_of(gate, known.label));
}

}  // namespace assay::harness
