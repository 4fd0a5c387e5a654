#include "harness/families/costs.h"

#include <stdexcept>

namespace assay::harness {

using stats::JointMoments;
using stats::Moments;

const JointMoments& by_its_cost(const Question& question, std::span<const JointMoments> joint) {
  return joint[question.test->cost == CostKind::samples ? samples_cost : rays_cost];
}

const JointMoments& counted_cost(const Question& question, const ChannelData& data) {
  const JointMoments& sample = by_its_cost(question, data.joint);
  if (sample.of_cost.mean > 0) return sample;
  throw std::domain_error(
      "no cost was counted: an estimator that traces no rays counts its `samples`; say "
      "`cost: samples`");
}

JointMoments powers_of_values(const ChannelData& data) {
  return data.joint.empty() ? stats::joint_of_four(data.moments) : data.joint.front();
}

Constant truth_of(const Question& question, std::size_t subject, std::size_t channel,
                  std::span<const ChannelData> data) {
  if (!question.has_reference_subject) return question.truths[subject][channel];
  const Moments& reference = data.back().moments;
  return {reference.mean, reference.standard_error()};
}

}  // namespace assay::harness
