#include "harness/theta/constant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/ready_made.h"
#include "harness/theta/theta.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

using reports::Verdict;

/// Largest probability that n observations can have left unseen, at this level.
double unseen(double level, std::uint64_t count) {
  return -std::expm1(std::log(level) / static_cast<double>(count));
}

/// How far a reference with an error of its own may be off, at this level.
double reach_of(const Constant& reference, double level) {
  if (reference.standard_error == 0) return 0;
  return reference.standard_error *
         stats::normal_quantile({stats::Tail::upper, std::log(level / 2)});
}

/// A difference of means and how far unseen values may take it either way.
struct Difference {
  double value = 0;
  double below = 0;
  double above = 0;
  double scale = 1;  ///< Theta's unit: 1 or |reference|.
};

/// A mean, and how far unseen values in the channel's declared range may take it.
Difference mean_of(const Channel& channel, const ChannelData& data, double level) {
  const double q = unseen(level, data.moments.count);
  const double mean = data.moments.mean;
  return {.value = mean,
          .below = q * std::max(0.0, mean - channel.low) + channel.rounding,
          .above = q * std::max(0.0, channel.high - mean) + channel.rounding};
}

Channel channel_of(const Question& question, std::size_t subject, std::size_t channel) {
  const Subject& side = question.subjects[subject];
  // Pictures declare nothing. Their millions of channel names are not made for one of them.
  if (recorded::unknown_channels(*side.setup)) return {};
  return side.setup->channels()[side.channels[channel]];
}

Difference from_number(const Question& question, std::size_t channel, const ChannelData& data,
                       double level) {
  const Constant& reference = question.references[channel];
  // The level is shared between the unseen values and the reference's own error.
  const double part = reference.standard_error > 0 ? level / 2 : level;
  const double reach = reach_of(reference, part);
  const Difference mean = mean_of(channel_of(question, 0, channel), data, part);
  return {.value = mean.value - question.offset - reference.value,
          .below = mean.below + reach,
          .above = mean.above + reach,
          .scale = question.theta->is_relative(question, channel) ? std::abs(reference.value) : 1};
}

Difference from_other(const Question& question, std::size_t channel,
                      std::span<const ChannelData> data, double level) {
  const Difference one = mean_of(channel_of(question, 0, channel), data[0], level / 2);
  const Difference two = mean_of(channel_of(question, 1, channel), data[1], level / 2);
  const double factor = std::abs(question.factor);
  const bool same_sign = question.factor > 0;
  const double reference = question.factor * two.value;
  return {.value = one.value - question.offset - reference,
          .below = one.below + factor * (same_sign ? two.above : two.below),
          .above = one.above + factor * (same_sign ? two.below : two.above),
          .scale = question.theta->is_relative(question, channel) && reference != 0
                       ? std::abs(reference)
                       : 1};
}

Difference difference_of(const Question& question, std::size_t channel,
                         std::span<const ChannelData> data, double level) {
  return question.of_two() ? from_other(question, channel, data, level)
                           : from_number(question, channel, data[0], level);
}

/// The difference as it was seen, but for rounding.
Difference as_seen(const Question& question, std::size_t channel, Difference difference) {
  double rounding = channel_of(question, 0, channel).rounding;
  if (question.of_two()) {
    rounding += std::abs(question.factor) * channel_of(question, 1, channel).rounding;
  }
  difference.below = rounding;
  difference.above = rounding;
  return difference;
}

/// All values that theta may have.
struct Span {
  double low;
  double high;
};

Span theta_of(const Difference& difference) {
  return {.low = (difference.value - difference.below) / difference.scale,
          .high = (difference.value + difference.above) / difference.scale};
}

bool meets_claimed(const Span& theta, const Regions& regions) {
  switch (regions.relation) {
    case Relation::equal:
      return theta.low <= regions.allow && theta.high >= -regions.allow;
    case Relation::at_most:
      return theta.low <= regions.allow;
    case Relation::at_least:
      return theta.high >= -regions.allow;
    case Relation::less:
      return theta.low < 0;
    case Relation::greater:
      return theta.high > 0;
    case Relation::within:
      break;
  }
  return theta.low < regions.within && theta.high > -regions.within;
}

bool meets_forbidden(const Span& theta, const Regions& regions) {
  switch (regions.relation) {
    case Relation::equal:
      return regions.detect && (theta.high >= *regions.detect || theta.low <= -*regions.detect);
    case Relation::at_most:
      return regions.detect && theta.high >= *regions.detect;
    case Relation::at_least:
      return regions.detect && theta.low <= -*regions.detect;
    case Relation::less:
      return theta.high >= 0;
    case Relation::greater:
      return theta.low <= 0;
    case Relation::within:
      break;
  }
  return theta.high >= regions.within || theta.low <= -regions.within;
}

/// Hint at the commonest cause of constant observations.
std::string seeds(const Question& question) {
  for (const Subject& subject : question.subjects) {
    if (subject.setup->observations()) return "; if they should vary, has each a seed of its own?";
    if (subject.estimator->entry->information.says_nature) {
      return "; if they should vary, does the program use the index of the observation?";
    }
  }
  return "";
}

/// True if unseen values can move the mean by a finite amount only.
bool has_range(const Difference& difference) {
  return std::isfinite(std::max(difference.below, difference.above));
}

ConstantVerdict agreeing(const Difference& at_beta, const Regions& regions, double beta) {
  if (!regions.has_forbidden()) {
    return {Verdict::pass,
            "every observation is the same and as claimed; values never seen are not ruled out"};
  }
  if (!meets_forbidden(theta_of(at_beta), regions)) {
    return {Verdict::pass,
            fmt::format("every observation is the same and as claimed; with the declared range, "
                        "values never seen could move the mean by at most {:.3g} (at level {:g})",
                        std::max(at_beta.below, at_beta.above), beta)};
  }
  return {Verdict::inconclusive,
          has_range(at_beta)
              ? "every observation is the same and as claimed, but the declared range does not "
                "bound closely enough what values never seen could add; give more observations"
              : "every observation is the same and as claimed, but what values never seen "
                "could add is bounded by no number of observations; declare the range"};
}

}  // namespace

bool is_constant(const Question& question, std::size_t subject, std::size_t channel,
                 const stats::Moments& moments) {
  return moments.maximum - moments.minimum <= 2 * channel_of(question, subject, channel).rounding;
}

double unseen_shift(const Question& question, std::size_t subject, std::size_t channel,
                    const ChannelData& data, double level) {
  const Difference mean = mean_of(channel_of(question, subject, channel), data, level);
  return std::max(mean.below, mean.above);
}

bool all_constant(const Question& question, std::size_t channel,
                  std::span<const ChannelData> data) {
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    if (!is_constant(question, subject, channel, data[subject].moments)) return false;
  }
  return true;
}

ConstantVerdict judge_constant(const Question& question, std::size_t channel,
                               std::span<const ChannelData> data, const Regions& regions,
                               const ErrorShare& share) {
  const Difference at_beta = difference_of(question, channel, data, share.beta);
  if (meets_claimed(theta_of(as_seen(question, channel, at_beta)), regions)) {
    return agreeing(at_beta, regions, share.beta);
  }
  const Difference at_alpha = difference_of(question, channel, data, share.alpha);
  const double mean = data[0].moments.mean;
  if (!meets_claimed(theta_of(at_alpha), regions)) {
    return {Verdict::fail, fmt::format("every observation is {:.10g}, and with the declared range "
                                       "values never seen cannot make up the difference{}",
                                       mean, seeds(question))};
  }
  return {
      Verdict::invalid,
      fmt::format("every observation is {:.10g}, which differs from the reference by {:.3g}; "
                  "without a spread there is no test, and a rare value may be unseen: {}{}",
                  mean, at_alpha.value,
                  has_range(at_alpha) ? "more `secondaries` would tell, as the range is declared"
                                      : "declare the range, or take more observations",
                  seeds(question))};
}

namespace {

/// The spread that rounding may hide, by the size of the values or as declared.
double hidden_deviation(const Question& question, std::size_t channel, const ChannelData& data) {
  const double size = std::abs(data.moments.mean) * question.subjects[0].averaged(data.primaries);
  const double spacing = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return std::max(spacing, 2 * channel_of(question, 0, channel).rounding);
}

}  // namespace

std::optional<ConstantVerdict> judge_constant_variance(const Question& question,
                                                       std::size_t channel, const ChannelData& data,
                                                       const Regions& regions) {
  if (regions.relation != Relation::at_most || regions.has_forbidden() ||
      !is_constant(question, 0, channel, data.moments)) {
    return {};
  }
  const double hidden = hidden_deviation(question, channel, data);
  if (hidden * hidden > question.references[channel].value) return {};
  return ConstantVerdict{
      Verdict::pass,
      fmt::format("every observation is {:.10g}, so that no variance was seen that could be too "
                  "large; values never seen are not ruled out",
                  data.moments.mean)};
}

}  // namespace assay::harness
