#pragma once

// The families offer these to the table of quantities and to each other. Each has one file.

#include <string>

#include "harness/theta/theta.h"

namespace assay::harness {

// Each binds a claim about its quantity. InputError at the claim's place if it cannot.
Question bind_mean(const TestEntry&, const Estimators&);
/// E x against reference + number. The reference is the analytic mean, or that of `reference:`.
Question bind_bias(const TestEntry&, const Estimators&);
Question bind_variance(const TestEntry&, const Estimators&);
/// Allows "at most" and "below" for the largest variance of several channels: every channel's is
/// bounded then.
Question bind_worst_variance(const TestEntry&, const Estimators&);
Question bind_total_variance(const TestEntry&, const Estimators&);
/// 1 / (error x cost). The error is the variance, or the mean squared error if the estimator is
/// biased by its class or the test names a `reference`.
Question bind_efficiency(const TestEntry&, const Estimators&);
/// Rays, samples or seconds (`cost:`), one number for all channels. They are those of a primary if
/// the estimator averages, else those of a secondary.
Question bind_cost(const TestEntry&, const Estimators&);
Question bind_quantile(const TestEntry&, const Estimators&);
Question bind_distribution(const TestEntry&, const Estimators&);
Question bind_integral(const TestEntry&, const Estimators&);
Question bind_inconsistency(const TestEntry&, const Estimators&);

const Theta& theta_of_means();
const Theta& theta_of_biases();
const Theta& theta_of_images();
const Theta& theta_of_bias_images();
const Theta& theta_of_image_laws();
const Theta& theta_of_variances();
const Theta& theta_of_costs();
const Theta& theta_of_efficiencies();
const Theta& theta_of_total_variances();
const Theta& theta_of_laws();
const Theta& theta_of_quantiles();
const Theta& theta_of_integrals();
const Theta& theta_of_inconsistencies();
const Theta& theta_of_slopes();
const Theta& theta_of_variance_slopes();

/// Values with their cost, in rays or samples. Throws std::domain_error if nothing was counted.
const stats::JointMoments& counted_cost(const Question& question, const ChannelData& data);
/// The powers of a channel's values, as far as they are kept: a cost means nothing.
stats::JointMoments powers_of_values(const ChannelData& data);
/// The truth of a subject's mean: its number, or the mean of the drawn reference.
Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data);
/// The known reference of a bias: ", reference 2.5"; "" if it is sampled.
std::string reference_text(const Question& question);
/// ", red" if the question has several channels.
std::string channel_suffix(const Question& question, std::size_t channel);

inline bool is_within(const Question& question) {
  return question.test->claim.relation == Relation::within;
}
inline bool any_question(const Question&) { return true; }

}  // namespace assay::harness
