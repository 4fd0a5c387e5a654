#include "harness/families/theta_error.h"

#include <cmath>
#include <optional>

#include "harness/theta/constant.h"
#include "harness/theta/method.h"
#include "harness/theta/scale.h"
#include "stats/variances/log_variance.h"

namespace assay::harness {
namespace {

/// One side's part of theta's error, before the unit.
double side_error(const Question& question, std::size_t subject, const ChannelData& data) {
  if (question.of_variances()) return stats::log_variance_standard_error(data.moments);
  return (subject == 0 ? 1 : std::abs(question.factor)) * data.moments.standard_error();
}

}  // namespace

std::optional<ThetaError> theta_error(const Question& question, std::size_t channel,
                                      std::span<const ChannelData> data) {
  if (!question.of_means() && !question.of_variances()) return std::nullopt;
  const double unit =
      unit_of_theta(question, channel, question.of_two() ? data[1].moments.mean : 0);
  ThetaError error;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double side = side_error(question, i, data[i]) / unit;
    double& part = question.subjects[i].setup->observations() ? error.fixed : error.drawn;
    part = std::hypot(part, side);
  }
  if (!question.references.empty()) {
    error.fixed = std::hypot(error.fixed, question.references[channel].standard_error / unit);
  }
  return error;
}

}  // namespace assay::harness
