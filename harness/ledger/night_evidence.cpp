#include "harness/ledger/night_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/text_hash.h"
#include "harness/plan/independence.h"
#include "harness/theta/theta.h"

namespace assay::harness {
namespace {

const ChannelOutcome* outcome_of(const TestOutcome& test, std::size_t channel) {
  for (const ChannelOutcome& outcome : test.channels) {
    if (outcome.index == channel) return &outcome;
  }
  return nullptr;
}

/// Why a test gives nothing that nights could pool; "" if it does.
std::string obstacle(const TestOutcome& test) {
  if (test.verdict == reports::Verdict::error) return "its verdict is error";
  if (!test.plan.invalid.empty()) return "its pilots leave it invalid";
  const std::vector<Subject>& sides = test.question.subjects;
  if (std::all_of(sides.begin(), sides.end(), is_recorded)) {
    return "its data are recorded: the same in every run";
  }
  return "";
}

// The kurtosis of squared normal values, for families that do not tell.
constexpr double usual_kurtosis = 15;

/// The night's weight and number, by the first side that is drawn in this run.
stats::NightEstimate sized(const TestOutcome& test, const ThetaError& error) {
  const std::vector<Subject>& sides = test.question.subjects;
  const auto drawn = std::find_if_not(sides.begin(), sides.end(), is_recorded);
  const auto i = static_cast<std::size_t>(drawn - sides.begin());
  const double secondaries = static_cast<double>(test.secondaries(i));
  return {.difference = *error.estimate,
          .standard_error = error.drawn,
          .observations = secondaries * static_cast<double>(test.plan.primaries[i]),
          .effective = std::max(1.0, error.effective.value_or(secondaries / usual_kurtosis))};
}

/// The error that an interval shows; nullopt without two ends, or if it holds more than one run's.
std::optional<ThetaError> error_of_interval(const Question& question, std::size_t channel,
                                            const Evidence& evidence) {
  const bool shares =
      std::any_of(question.subjects.begin(), question.subjects.end(), is_recorded) ||
      (!question.references.empty() && question.references[channel].standard_error > 0);
  if (shares) return std::nullopt;
  constexpr double one_standard_deviation = 0.6826894921370859;
  const stats::Interval interval = evidence.interval(one_standard_deviation);
  const double half = (interval.high - interval.low) / 2;
  if (!std::isfinite(half)) return std::nullopt;
  return ThetaError{.drawn = half};
}

std::variant<NightEvidence, NoEvidence> of_estimate(const DrawnTest& drawn, std::size_t channel) {
  const Question& question = drawn.outcome.question;
  const std::vector<ChannelData> data = data_of(drawn, channel);
  std::optional<ThetaError> error = question.theta->error(question, channel, data);
  const ChannelOutcome* outcome = outcome_of(drawn.outcome, channel);
  if (outcome != nullptr) {
    if (!error) error = error_of_interval(question, channel, outcome->evidence);
    if (error) error->estimate = outcome->evidence.estimate;
  }
  if (!error) return NoEvidence{"no error of its estimate is known"};
  if (!error->estimate) return NoEvidence{"its observations have no spread"};
  return NightEvidence{.value = sized(drawn.outcome, *error), .reference_error = error->fixed};
}

std::string margin_text(const std::optional<Margin>& margin) {
  return margin ? to_string(*margin) : "none";
}

std::string side_text(const TestWork& work, std::size_t subject, std::size_t channel) {
  const Subject& side = work.outcome.question.subjects[subject];
  const PreparedEstimator& estimator = *side.estimator;
  std::string text = fmt::format(
      "\n{} {} {} {}", estimator.entry->information.name, estimator.parameters,
      estimator.primaries ? fmt::format("{}", *estimator.primaries) : "auto", side.purpose);
  if (!is_recorded(side)) return text;
  const Sample sample = work.sample(subject);
  if (const Drawn* const rows = sample.drawn()) {
    const stats::Moments moments = rows->summary().moments(side.channels[channel]);
    text += fmt::format(" {} {} {}", moments.count, moments.mean, moments.m2);
  }
  return text;
}

constexpr double zeta_3 = 1.2020569031595942;
constexpr double credibility = 0.9;

std::vector<stats::NightEstimate> estimates_of(const std::vector<LedgerNight>& nights) {
  std::vector<stats::NightEstimate> estimates;
  for (const LedgerNight& night : nights) {
    estimates.push_back(std::get<stats::NightEstimate>(night.value));
  }
  return estimates;
}

std::vector<double> log_p_values_of(const std::vector<LedgerNight>& nights) {
  std::vector<double> log_p;
  for (const LedgerNight& night : nights) {
    log_p.push_back(std::get<NightPValue>(night.value).log_p);
  }
  return log_p;
}

/// The null hypothesis at the nearest value that the claim allows.
stats::NullTheta nearest(const ThetaRange& claimed, const stats::PooledNights& pooled,
                         const LedgerSeries& series) {
  return {.value = std::clamp(pooled.difference(), claimed.low, claimed.high),
          .reference_error = *series.reference_error};
}

}  // namespace

std::variant<NightEvidence, NoEvidence> night_evidence(const TestWork& work, std::size_t channel) {
  const TestOutcome& test = work.outcome;
  if (std::string why = obstacle(test); !why.empty()) return NoEvidence{std::move(why)};
  const std::optional<DrawnTest> numbers = drawn(work);
  if (!numbers) return NoEvidence{"it was not drawn"};
  const ChannelOutcome* outcome = outcome_of(test, channel);
  if (outcome == nullptr || !outcome->evidence.distance) return of_estimate(*numbers, channel);
  const std::vector<Subject>& sides = test.question.subjects;
  if (std::any_of(sides.begin(), sides.end(), is_recorded)) {
    return NoEvidence{
        "one side is recorded, the same in every run, and distances from it do not add up"};
  }
  return NightEvidence{.value = NightPValue{.log_p = outcome->decision.log_p_claimed}};
}

std::string series_hash(const TestWork& work, std::size_t channel) {
  const Question& question = work.outcome.question;
  const TestEntry& entry = *question.test;
  std::string text = fmt::format("{}\nallow {} detect {}\nchannel {}", to_string(entry.claim),
                                 margin_text(entry.allow), margin_text(entry.detect),
                                 question.channel_name(channel));
  for (std::size_t i = 0; i < question.subjects.size(); ++i) text += side_text(work, i, channel);
  if (!question.references.empty()) {
    const Constant& reference = question.references[channel];
    // Twelve digits: quadratures may differ in the last ones between machines.
    text += fmt::format("\n{:.12g} {:.12g}", reference.value, reference.standard_error);
  }
  return fmt::format("{:016x}", text_hash(text));
}

stats::PooledNights pooled_nights(const std::vector<LedgerNight>& nights) {
  stats::PooledNights pooled;
  for (const stats::NightEstimate& night : estimates_of(nights)) pooled.add(night);
  return pooled;
}

std::vector<double> log_e_path(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
                               const ThetaRange& claimed) {
  std::vector<double> path;
  if (series.has_estimates()) {
    stats::PooledNights pooled;
    for (const stats::NightEstimate& night : estimates_of(nights)) {
      pooled.add(night);
      path.push_back(stats::log_e_value(pooled, nearest(claimed, pooled, series)));
    }
    return path;
  }
  stats::PooledPValues pooled;
  for (const double log_p : log_p_values_of(nights)) {
    pooled.add(log_p);
    path.push_back(stats::log_e_value(pooled));
  }
  return path;
}

Moved moved(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
            const ThetaRange& claimed) {
  const auto change = [&] {
    if (!series.has_estimates()) return stats::change_point(log_p_values_of(nights));
    return stats::change_point(estimates_of(nights),
                               nearest(claimed, pooled_nights(nights), series));
  }();
  const std::vector<std::size_t> credible = stats::credible_nights(change, credibility);
  return {change.night, credible.front(), credible.back()};
}

double generation_share(int generation) { return 1 / (zeta_3 * std::pow(generation, 3)); }

}  // namespace assay::harness
