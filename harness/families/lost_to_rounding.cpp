#include "harness/families/lost_to_rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/theta/constant.h"
#include "stats/basics/mean_rounding.h"

namespace assay::harness {
namespace {

// Part of the standard error that rounding may reach: a 1 % tail then moves by a third at most.
constexpr double tolerated = 0.1;

/// Errors of one side, on the scale of the first mean.
struct RoundedPart {
  double rounding = 0;
  double standard_error = 0;
};

RoundedPart part_of(const Question& question, std::size_t subject, const ChannelData& data) {
  if (data.moments.count < 2) return {};
  const double factor = subject == 0 ? 1 : std::abs(question.factor);
  return {.rounding = factor * stats::rounding_of_mean(data.moments),
          .standard_error = factor * data.moments.standard_error()};
}

/// Standard deviation that rounding adds to a mean of so many, summed one by one. Each step adds a
/// variance of spacing^2 / 12. The spacing grows with the sum, so its square averages a third of
/// the last one's.
double rounding_of_sum(double mean, double primaries) {
  const double sum = std::abs(mean) * primaries;
  const double spacing = std::nextafter(sum, std::numeric_limits<double>::infinity()) - sum;
  return spacing * std::sqrt(primaries / 36) / primaries;
}

std::string variance_without_spread(const Question& question, std::size_t channel,
                                    std::span<const ChannelData> data) {
  for (std::size_t subject = 0; subject < question.compared(); ++subject) {
    if (is_constant(question, subject, channel, data[subject].moments)) {
      return fmt::format(
          "every observation of `{}` is {:.10g} but for rounding: a sample without spread says "
          "nothing of a variance, and a rare value may be unseen; take more observations{}",
          question.subjects[subject].estimator->name, data[subject].moments.mean,
          question.of_two() ? ", or compare the other with a number" : "");
    }
  }
  return "";
}

}  // namespace

std::string lost_to_rounding(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data) {
  std::size_t worst = 0;
  double most = 0;
  double rounding = 0;
  double error = question.of_two() ? 0 : question.references[channel].standard_error;
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    const RoundedPart part = part_of(question, subject, data[subject]);
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

std::string variances_lost_to_rounding(const Subject& side, std::uint64_t primaries,
                                       std::span<const stats::Moments> channels) {
  const double averaged = side.averaged(primaries);
  double added = 0;
  double total = 0;
  double squared_error = 0;
  double mean = 0;
  for (const stats::Moments& x : channels) {
    if (averaged <= 1 || x.count < 2 || !(x.m2 > 0)) continue;  // a single number is no sum
    const double count = static_cast<double>(x.count);
    added += std::pow(rounding_of_sum(x.mean, averaged), 2);
    total += x.variance();
    // Two equally frequent values have kurtosis 1 and an error of second order.
    squared_error += std::pow(x.variance(), 2) * std::max(x.kurtosis() - 1, 1 / count) / count;
    if (std::abs(x.mean) > std::abs(mean)) mean = x.mean;
  }
  if (!(added > tolerated * std::sqrt(squared_error))) return "";
  return fmt::format(
      "the mean of `{}` is {:.6g}: sums of {:g} numbers of that size are rounded so coarsely that "
      "their variance is larger by a part of {:.2g} where its standard error is {:.2g}; take a "
      "constant near the mean off the observations",
      side.estimator->name, mean, averaged, added / total, std::sqrt(squared_error) / total);
}

std::string lack_of_variance(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data) {
  std::string reason = variance_without_spread(question, channel, data);
  for (std::size_t i = 0; i < question.compared() && reason.empty(); ++i) {
    reason =
        variances_lost_to_rounding(question.subjects[i], data[i].primaries, {&data[i].moments, 1});
  }
  return reason;
}

}  // namespace assay::harness
