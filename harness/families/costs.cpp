#include "harness/families/costs.h"

#include <stdexcept>

#include "stats/gates/assumption_gates.h"

namespace assay::harness {

using stats::JointMoments;
using stats::Moments;

const JointMoments& by_its_cost(const Question& question, std::span<const JointMoments> with_cost) {
  return with_cost[question.test->cost == CostKind::samples ? samples_cost : rays_cost];
}

const JointMoments& counted_cost(const Question& question, const ChannelData& data) {
  const JointMoments& sample = by_its_cost(question, data.with_cost);
  if (sample.cost.mean > 0) return sample;
  throw std::domain_error(
      "no cost was counted: an estimator that traces no rays counts its `samples`; say "
      "`cost: samples`");
}

Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data) {
  if (!question.has_reference_subject) return question.truths[subject][channel];
  const Moments& reference = data.back().moments;
  return {reference.mean, reference.standard_error()};
}

std::vector<Gate> log_mean_gates(const TestOutcome& outcome, std::size_t channel,
                                 std::span<const ChannelData> data, double x) {
  std::vector<Gate> gates;
  const Question& question = outcome.question;
  const Keeps keeps = outcome.plan.method.keeps;
  const bool variances = keeps == Keeps::group_variances;
  if (channel != 0 || (keeps != Keeps::costs && !variances)) return gates;
  for (std::size_t subject = 0; subject < question.compared(); ++subject) {
    const stats::Moments& values = variances ? data[subject].group_variances
                                             : by_its_cost(question, data[subject].with_cost).cost;
    if (!(values.m2 > 0 && values.mean > 0)) continue;
    gates.push_back(gate_of(stats::log_mean_gate(values, x, variances ? "variance" : "cost"),
                            " of " + question.subjects[subject].estimator->name));
  }
  return gates;
}

}  // namespace assay::harness
