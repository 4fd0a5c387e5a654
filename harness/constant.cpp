#include "harness/constant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stats/tails.h"

namespace assay::harness {
namespace {

using reports::Verdict;

const Channel& channel_of(const std::vector<Channel>& channels, const Subject& subject,
                          std::size_t channel) {
  return channels[subject.channels[channel]];
}

/// Largest probability that n observations can have left unseen, at this level.
double unseen(double level, std::uint64_t count) {
  return -std::expm1(std::log(level) / static_cast<double>(count));
}

struct Bound {
  double below = 0;  ///< the mean is at least constant - below
  double above = 0;  ///< and at most constant + above
};

/// How far a reference with an error of its own may be off, at this level.
double reach_of(const Constant& reference, double level) {
  if (reference.standard_error == 0) return 0;
  return reference.standard_error *
         stats::normal_quantile({stats::Tail::upper, std::log(level / 2)});
}

Bound mean_bound(const Channel& channel, const ChannelData& data, double level) {
  const double q = unseen(level, data.moments.count);
  return {.below = q * (data.moments.mean - channel.low),
          .above = q * (channel.high - data.moments.mean)};
}

/// Of the difference between subjects (or from the number), on theta's scale.
struct Difference {
  double value;
  double scale;     ///< of theta: 1, or the reference
  double rounding;  ///< and error of the reference: what is no difference
  Bound bound;
};

Difference difference_of(const Question& question, std::size_t channel,
                         std::span<const ChannelData> data, double level) {
  const std::vector<Channel> first = question.subjects[0].setup->channels();
  const Channel& mine = channel_of(first, question.subjects[0], channel);
  const Bound one = mean_bound(mine, data[0], question.of_two() ? level / 2 : level);
  if (!question.of_two()) {
    const Constant& reference = question.references[channel];
    const double reach = reach_of(reference, level);
    return {.value = data[0].moments.mean - reference.value,
            .scale = is_relative(question, channel) ? std::abs(reference.value) : 1,
            .rounding = mine.rounding + reach,
            .bound = {.below = one.below + reach, .above = one.above + reach}};
  }
  const std::vector<Channel> second = question.subjects[1].setup->channels();
  const Channel& theirs = channel_of(second, question.subjects[1], channel);
  const Bound two = mean_bound(theirs, data[1], level / 2);
  const double reference = question.factor * data[1].moments.mean;
  const double factor = std::abs(question.factor);
  return {
      .value = data[0].moments.mean - reference,
      .scale = is_relative(question, channel) ? std::abs(reference) : 1,
      .rounding = mine.rounding + factor * theirs.rounding,
      .bound = {.below = one.below + factor * two.above, .above = one.above + factor * two.below}};
}

ConstantVerdict equal(const Difference& difference, const Regions& regions,
                      const ErrorShare& share) {
  const double most = std::max(difference.bound.below, difference.bound.above) / difference.scale;
  const double margin =
      regions.relation == Relation::within ? regions.within : regions.detect.value_or(0);
  if (!regions.has_forbidden()) {
    return {Verdict::pass,
            "every observation equals the reference; values never seen are not ruled out"};
  }
  if (margin > 0 && most < margin) {
    return {Verdict::pass,
            fmt::format("every observation equals the reference; with the declared range, values "
                        "never seen could move the mean by at most {:.3g} (at level {:g})",
                        most * difference.scale, share.beta)};
  }
  return {Verdict::inconclusive,
          "every observation equals the reference, and no declared range bounds what values never "
          "seen could add; declare the range or give more observations"};
}

}  // namespace

bool is_constant(const Question& question, std::size_t subject, std::size_t channel,
                 const stats::Moments& moments) {
  const Subject& side = question.subjects[subject];
  const std::vector<Channel> channels = side.setup->channels();
  return moments.maximum - moments.minimum <= 2 * channel_of(channels, side, channel).rounding;
}

ConstantVerdict judge_constant(const Question& question, std::size_t channel,
                               std::span<const ChannelData> data, const Regions& regions,
                               const ErrorShare& share) {
  const Difference at_beta = difference_of(question, channel, data, share.beta);
  if (std::abs(at_beta.value) <= at_beta.rounding) return equal(at_beta, regions, share);
  const Difference at_alpha = difference_of(question, channel, data, share.alpha);
  const double low = (at_alpha.value - at_alpha.bound.below) / at_alpha.scale;
  const double high = (at_alpha.value + at_alpha.bound.above) / at_alpha.scale;
  const double allow = regions.relation == Relation::within ? regions.within : regions.allow;
  const bool above = low > allow && regions.relation != Relation::at_least &&
                     regions.relation != Relation::greater;
  const bool below =
      high < -allow && regions.relation != Relation::at_most && regions.relation != Relation::less;
  if (above || below) {
    return {Verdict::fail, fmt::format("every observation is {:.10g}, and with the declared range "
                                       "values never seen cannot make up the difference",
                                       data[0].moments.mean)};
  }
  return {Verdict::invalid,
          fmt::format("every observation is {:.10g}, which differs from the reference by {:.3g}; "
                      "without a spread there is no test, and a rare value may be unseen: declare "
                      "the range, or take more observations",
                      data[0].moments.mean, at_alpha.value)};
}

}  // namespace assay::harness
