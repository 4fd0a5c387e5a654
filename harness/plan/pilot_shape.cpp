#include "harness/plan/pilot_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/plan/critical.h"
#include "harness/plan/rows.h"
#include "harness/plan/secondaries.h"
#include "harness/question/declared_range.h"
#include "harness/sampling/beyond_doubles.h"
#include "harness/theta/constant.h"
#include "harness/theta/gate.h"

namespace assay::harness {
namespace {

using stats::GateState;

/// Gates of the last tails asked for. A fit is slow, and an estimator's tests ask for the same
/// tails again.
class KnownTails {
 public:
  stats::Gate gate(std::span<const double> largest, std::size_t count, stats::TailClaim claim) {
    for (const Entry& entry : entries_) {
      if (entry.count == count && entry.claim == claim &&
          std::equal(entry.largest.begin(), entry.largest.end(), largest.begin(), largest.end())) {
        return entry.gate;
      }
    }
    Entry& entry = entries_[next_++ % entries_.size()];
    entry = {
        {largest.begin(), largest.end()}, count, claim, stats::pareto_gate(largest, count, claim)};
    return entry.gate;
  }

 private:
  struct Entry {
    std::vector<double> largest = {};
    std::size_t count = 0;
    stats::TailClaim claim = {};
    stats::Gate gate = {};
  };
  std::array<Entry, 16> entries_{};
  std::size_t next_ = 0;
};

/// One tail's gate, from values signed so that it is the right one. Reorders them.
stats::Gate right_tail_gate(std::vector<double>& values, stats::TailClaim claim) {
  thread_local KnownTails known;
  const std::size_t tail = stats::pareto_tail_size(values.size()) + 1;
  const auto first = values.end() - static_cast<std::ptrdiff_t>(tail);
  std::nth_element(values.begin(), first, values.end());
  std::sort(first, values.end());
  return known.gate(std::span<const double>(values).last(tail), values.size(), claim);
}

/// True if a tail is seen to its declared end, so that nothing heavier can hide in it.
bool ends_in_sight(double farthest, double mean, double declared) {
  return std::isfinite(declared) && std::abs(farthest - mean) >= std::abs(declared - mean) / 2;
}

// Fewest values for a tail's fit. A small pilot shows the index only roughly, so it is red only
// with a large kurtosis.
constexpr std::size_t least_of_a_tail = 500;
bool is_small(std::uint64_t count) { return count < usual_secondaries; }

/// State at the estimate. A lattice or a rare second part can look like a heavy tail. It is none
/// while the variance of the variance, (kurtosis - 1) / n, is small. If that is large, the pilot
/// does not know the variance yet.
GateState tail_state(const stats::Gate& gate, const stats::Moments& moments,
                     stats::TailClaim claim) {
  const bool mean = claim == stats::TailClaim::mean;
  const double variance_of_variance = (moments.kurtosis() - 1) / static_cast<double>(moments.count);
  // Only a surely light tail explains such a kurtosis.
  if (!mean && variance_of_variance > (is_small(moments.count) ? 0.05 : 0.01) && gate.value > 0.1) {
    return GateState::red;
  }
  if (gate.value <= gate.limit) return GateState::green;
  if (is_small(moments.count)) return GateState::amber;
  return variance_of_variance > (mean ? 0.1 : 0.001) ? GateState::red : GateState::amber;
}

/// The heavier tail's gate, at the estimate: the pilot chooses, it does not accuse.
std::optional<stats::Gate> tail_gate(const Question& question, const Known& known,
                                     stats::TailClaim claim) {
  const stats::Moments& moments = known.pilot.moments;
  std::vector<double> values(known.pilot.values.begin(), known.pilot.values.end());
  const bool finite =
      std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  const bool few = is_small(values.size()) && (known.rows || claim == stats::TailClaim::mean);
  if (few || values.size() < least_of_a_tail || !finite) return {};
  std::optional<stats::Gate> heavier;
  const stats::Range range = range_of(question, known.subject, known.channel, moments);
  if (known.rows || !ends_in_sight(moments.maximum, moments.mean, range.high)) {
    heavier = right_tail_gate(values, claim);
  }
  if (known.rows || !ends_in_sight(moments.minimum, moments.mean, range.low)) {
    for (double& value : values) value = -value;
    const stats::Gate left = right_tail_gate(values, claim);
    if (!heavier || left.value > heavier->value) heavier = left;
  }
  if (!heavier) return {};
  heavier->low = heavier->value;
  heavier->state = tail_state(*heavier, moments, claim);
  return heavier;
}

}  // namespace

std::string unusable_pilot(const Question& question, const Pilots& pilots) {
  if (question.is().of_single_values) return "";
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* pilot = pilot_of(question, subject, pilots);
    if (pilot == nullptr || pilot->look || !side.purpose.empty()) continue;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const stats::Moments moments = pilot->moments(side.channels[channel]);
      const std::string reason = beyond_doubles(moments, side.estimator->name);
      if (!reason.empty() && !is_constant(question, subject, channel, moments)) return reason;
    }
  }
  return "";
}

std::vector<Known> known_channels(const Question& question, const Pilots& pilots,
                                  std::uint64_t look, const Plan& plan) {
  std::vector<Known> all;
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* pilot = pilot_of(question, subject, pilots);
    if (pilot == nullptr || !side.purpose.empty()) continue;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const PilotChannel data = pilot_channel(side, *pilot, channel);
      if (is_constant(question, subject, channel, data.moments)) continue;
      const std::string part =
          side.channels.size() > 1 ? "." + side.setup->channels()[side.channels[channel]].name : "";
      all.push_back({.subject = subject,
                     .channel = channel,
                     .pilot = data,
                     .averaged = side.averaged(plan.primaries[subject]),
                     .times = times_the_fewest(question, subject, look),
                     .rows = side.setup->observations().has_value(),
                     .label = fmt::format(", pilot of {}{}", side.estimator->name, part)});
    }
  }
  return all;
}

std::vector<double> as_secondaries(const Subject& side, std::span<const double> values,
                                   std::uint64_t primaries) {
  const std::uint64_t each = side.averages && !is_recorded(side) ? primaries : 1;
  std::vector<double> means;
  for (std::size_t i = 0; i + each <= values.size(); i += each) {
    double sum = 0;
    for (std::uint64_t k = 0; k < each; ++k) sum += values[i + k];
    means.push_back(sum / static_cast<double>(each));
  }
  return means;
}

void answer_red_gates(Plan& plan) {
  for (Gate& gate : plan.gates) {
    if (gate.state == "red") gate.state = "amber";
  }
}

void note(Plan& plan, const Known& known, const stats::Gate& gate) {
  if (!known.rows) plan.gates.push_back(gate_of(gate, known.label));
}

std::string too_heavy(const Question& question, const std::vector<Known>& channels,
                      stats::TailClaim claim, Plan& plan) {
  std::string reason;
  const bool mean = claim == stats::TailClaim::mean;
  for (const Known& known : channels) {
    const std::optional<stats::Gate> gate = tail_gate(question, known, claim);
    if (!gate) continue;
    note(plan, known, *gate);
    if (gate->state != GateState::red) continue;
    if (has_rows(question)) {
      reason = fmt::format(
          "the rows are too heavy-tailed for a {}: more of them may only show more of the tail; "
          "claim a quantile, as `quantile({}, 0.5) == …`",
          mean ? "mean" : "variance", to_string(question.test->claim.left.source));
      continue;
    }
    reason = fmt::format(
        "its tail is too heavy (index {:.2g}, limit {:.2g}{}): the {} moment that the test rests "
        "on may not exist; clamp the estimator{}, or claim something of its distribution",
        gate->value, gate->limit, known.label, mean ? "second" : "fourth",
        mean ? ", declare its range" : "");
  }
  return reason;
}

std::uint64_t enough_for_t(const std::vector<Known>& channels, double critical) {
  double needed = 2;
  for (const Known& known : channels) {
    const double skewness = stats::primary_shape(known.pilot.moments).skewness;
    const double root = std::abs(skewness) * std::pow(critical, 3) / (3 * std::log(level_factor));
    const double wanted = root * root / known.averaged / known.times;
    needed = wanted <= needed ? needed : wanted;  // also if it is NaN
  }
  return whole_secondaries(needed);
}

}  // namespace assay::harness
