#include "harness/ledger/night_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/text_hash.h"
#include "harness/plan/forecast.h"
#include "harness/plan/rows.h"
#include "harness/theta/theta.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

// (effect / a night's standard error)^2. It suits a bias of one standard error a night, and loses
// little at a third or three times of that.
constexpr double prior_variance = 0.2;

const ChannelOutcome* outcome_of(const TestOutcome& test, std::size_t channel) {
  for (const ChannelOutcome& outcome : test.channels) {
    if (outcome.index == channel) return &outcome;
  }
  return nullptr;
}

/// Why a test gives nothing that nights could add up; "" if it does.
std::string obstacle(const TestWork& work, std::size_t channel) {
  const TestOutcome& test = work.outcome;
  if (test.verdict == reports::Verdict::error || test.verdict == reports::Verdict::invalid) {
    return fmt::format("its verdict is {}", reports::to_string(test.verdict));
  }
  const std::vector<Subject>& sides = test.question.subjects;
  if (std::all_of(sides.begin(), sides.end(), is_recorded)) {
    return "its data are recorded: the same in every run";
  }
  const bool laws = !test.question.is().of_moments;
  if (laws && std::any_of(sides.begin(), sides.end(), is_recorded)) {
    return "one side is recorded, the same in every run, and distances from it do not add up";
  }
  const bool scored = evidence_kind(test) == EvidenceKind::score;
  if (scored && outcome_of(test, channel) == nullptr) return "its observations have no spread";
  return "";
}

/// The normal quantile of the p-value of theta = 0, with theta's sign; 0 if a conservative method
/// finds neither side likelier.
double z_of(const stats::TestResult& at_null) {
  const double log_p = std::min(at_null.log_p_upper, at_null.log_p_lower);
  if (log_p >= std::log(0.5)) return 0;
  const double z = stats::normal_quantile({stats::Tail::upper, log_p});
  return at_null.log_p_upper < at_null.log_p_lower ? z : -z;
}

/// The effect that a series looks for, from the pilot; nullopt without spread.
std::optional<double> prior_effect(const TestOutcome& test, std::size_t channel,
                                   const Pilots& pilots) {
  const auto data = expected_data(test, channel, pilots, expected_secondaries(test, pilots));
  if (!data) return std::nullopt;
  const std::optional<ThetaError> error = test.question.theta->error(test.question, channel, *data);
  if (!error || !(error->drawn > 0)) return std::nullopt;
  return std::sqrt(prior_variance) * error->drawn;
}

NightEvidence of_score(const DrawnTest& drawn, std::size_t channel, const Pilots& pilots) {
  const TestOutcome& test = drawn.outcome;
  const std::optional<double> effect = prior_effect(test, channel, pilots);
  if (!effect) return {.missing = "its pilot has no spread to expect a night's error from"};
  const std::vector<ChannelData> data = data_of(drawn, channel);
  const ThetaError error = test.question.theta->error(test.question, channel, data).value();
  if (!(error.drawn > 0)) return {.missing = "its observations have no spread"};
  const double total = std::hypot(error.drawn, error.fixed);
  const double difference = z_of(outcome_of(test, channel)->at_null) * total;
  return {.evidence = stats::evidence_of({difference, error.drawn}),
          .prior = {.effect = *effect, .reference_error = error.fixed}};
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

}  // namespace

EvidenceKind evidence_kind(const TestOutcome& test) {
  const bool moments = test.question.is().of_moments;
  return moments && test.plan.method.is.scores ? EvidenceKind::score : EvidenceKind::log_e;
}

NightEvidence night_evidence(const TestWork& work, std::size_t channel, const Pilots& pilots) {
  if (std::string missing = obstacle(work, channel); !missing.empty()) {
    return {.missing = std::move(missing)};
  }
  const TestOutcome& test = work.outcome;
  const std::optional<DrawnTest> numbers = drawn(work);
  if (!numbers) return {.missing = "it was not drawn"};
  if (evidence_kind(test) == EvidenceKind::score) return of_score(*numbers, channel, pilots);
  // Without spread there is no test: p = 1, which counts against an alarm.
  const ChannelOutcome* outcome = outcome_of(test, channel);
  const double log_p = outcome != nullptr ? outcome->decision.log_p_claimed : 0;
  return {.kind = EvidenceKind::log_e, .log_e = stats::log_e_from_log_p(log_p)};
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

}  // namespace assay::harness
