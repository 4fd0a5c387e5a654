#include "harness/lost_to_rounding.h"

#include <fmt/format.h>

#include <cmath>

#include "stats/mean_rounding.h"

namespace assay::harness {
namespace {

// Moves a tail of one per cent by a third, if it were all to one side.
constexpr double tolerated = 0.1;

/// On the scale of the first mean.
struct Part {
  double rounding = 0;
  double standard_error = 0;
};

Part part_of(const Question& question, std::size_t subject, const ChannelData& data) {
  if (data.moments.count < 2) return {};
  const double factor = subject == 0 ? 1 : std::abs(question.factor);
  return {.rounding = factor * stats::rounding_of_mean(data.moments),
          .standard_error = factor * data.moments.standard_error()};
}

}  // namespace

std::string lost_to_rounding(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data) {
  std::size_t worst = 0;
  double most = 0;
  double rounding = 0;
  double error = question.of_two() ? 0 : question.references[channel].standard_error;
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    const Part part = part_of(question, subject, data[subject]);
    if (part.rounding > most) worst = subject;
    most = std::max(most, part.rounding);
    rounding = std::hypot(rounding, part.rounding);
    error = std::hypot(error, part.standard_error);
  }
  if (!(rounding > tolerated * error)) return "";
  return fmt::format(
      "the mean of `{}` is {:.6g}: numbers of that size are rounded so coarsely that their mean is "
      "off by about {:.2g} where the standard error is {:.2g}; take a constant near the mean off "
      "the observations",
      question.subjects[worst].estimator->name, data[worst].moments.mean, rounding, error);
}

}  // namespace assay::harness
