#include "harness/question/declared_range.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "estimators/ready_made.h"
#include "harness/draws/sampler_setup.h"

namespace assay::harness {

std::string outside_of_range(const Subject& subject, const Summary& drawn) {
  // A mutant has its original's declaration.
  const bool mutant = !subject.estimator->entry->information.original.empty();
  if (mutant || drawn.elements || subject.setup->observations()) return "";
  const std::vector<Channel> channels = subject.setup->channels();
  const auto finite = [](double end) { return std::isfinite(end) ? std::abs(end) : 0; };
  for (const std::size_t i : subject.channels) {
    const Channel& channel = channels[i];
    const double slack = 1e-9 * (finite(channel.low) + finite(channel.high));
    const stats::Moments& seen = drawn.channels[i].moments;
    if (seen.count == 0) continue;
    const bool above = seen.maximum > channel.high + slack;
    if (!above && !(seen.minimum < channel.low - slack)) continue;
    return fmt::format(
        "`{}` gave {:.17g} in its channel `{}`, {} {:.17g}, which it declares to be "
        "its `{}`",
        subject.estimator->name, above ? seen.maximum : seen.minimum, channel.name,
        above ? "above" : "below", above ? channel.high : channel.low, above ? "high" : "low");
  }
  return "";
}

stats::Range range_of(const Question& question, std::size_t subject, std::size_t channel,
                      const stats::Moments& moments) {
  const Subject& side = question.subjects[subject];
  if (side.setup->observations()) return {moments.minimum, moments.maximum};
  const Channel declared = side.setup->channels()[side.channels[channel]];
  return {declared.low, declared.high};
}

double rounding_of(const Question& question, std::size_t subject, std::size_t channel) {
  const Subject& side = question.subjects[subject];
  // Pictures declare nothing. Their millions of channel names are not made for one of them.
  if (recorded::unknown_channels(*side.setup)) return 0;
  return side.setup->channels()[side.channels[channel]].rounding;
}

std::optional<double> no_point_of(const Subject& side) {
  const auto* draws = dynamic_cast<const SamplerSetup*>(side.setup.get());
  if (draws == nullptr) return std::nullopt;
  return no_point(draws->marginals()[side.channels[0]]);
}

}  // namespace assay::harness
