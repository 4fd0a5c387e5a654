#pragma once

#include <string>

#include "harness/question/question.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

/// Names a value outside the range that its channel declares (`low`, `high`), beyond a sum's
/// rounding; "" if there is none. The range decides on methods, above all `betting`. Mutants (which
/// have their original's declaration), images and ready-made data are not checked.
std::string outside_of_range(const Subject& subject, const Summary& drawn);

/// A channel's declared range; for recorded data the range of their values.
stats::Range range_of(const Question& question, std::size_t subject, std::size_t channel,
                      const stats::Moments& moments);

/// The rounding that a channel declares of its values.
double rounding_of(const Question& question, std::size_t subject, std::size_t channel);

/// The value of a subject's first channel that stands for "no point"; only samplers have one.
std::optional<double> no_point_of(const Subject& side);

}  // namespace assay::harness
