#pragma once

// Parts of a claim, bound to a suite's estimators.

#include <string>
#include <vector>

#include "harness/question/question.h"
#include "harness/sampling/summary.h"
#include "stats/means/student_t.h"

namespace assay::harness {

/// The source's estimator. InputError, with a near name, if the suite has none.
const PreparedEstimator& estimator_of(const Source& source, const Estimators& estimators);

/// The estimator's secondary estimates: all tested channels, or the one that the part names.
Subject estimates(const Source& source, const PreparedEstimator& estimator);
Subject estimates(const Source& source, const Estimators& estimators);

/// Views of a sampler's draws: cells of the whole domain, marginals (all or one), or consistency.
enum class Draws { cells, marginals, consistency };
Subject draws(const Source& source, const Estimators& estimators, Draws what);

/// The source of a distribution: the channel that the part names, else a sampler.
Subject values(const Source& source, const Estimators& estimators);

/// The plugin's analytic mean. InputError if it has none.
Constant analytic_mean(const Channel& channel, const Source& source);
Constant analytic_variance(const Channel& channel, const Source& source);

/// The right side for each channel: the claim's number, or what the plugin knows.
std::vector<Constant> references_of(const Claim& claim, const Subject& subject);

/// "32 x 32 irradiance".
std::string image_name(const ImageShape& shape);

/// The stream of a subject's observations.
StreamKey stream_of(const Subject& subject, std::uint64_t seed);

/// The stream of a sampler's cells (SamplerSetup): of the suite's seed, and the same in a replay.
StreamKey stream_of_cells(const PreparedEstimator& estimator, const std::string& sampler,
                          std::uint64_t seed);

/// InputError at the claim if it needs more of a recorded run than moments.
void require_moments_suffice(const Question& question);

/// The quantity on the right; null if there is another side.
const ScaledQuantity* other_side(const Claim& claim);

/// The true mean of each channel: the number of `reference:`, else the plugin's.
std::vector<Constant> truths_of(const TestEntry& test, const Subject& subject,
                                const Source& source);

/// Adds the drawn `reference` of the test, if it has one.
void add_reference(Question& question, const Estimators& estimators);

/// InputError for a claim in seconds on data that are read: seconds are measured over blocks of
/// drawing.
void require_drawn(const Question& question);

/// InputError for a margin in per cent.
void require_absolute(const Margin& margin, const char* reason);

/// The largest relative error of a number that is drawn: an image's are in single precision.
double relative_rounding(const Setup& setup);

/// Names a value outside the range that its channel declares (`low`, `high`), beyond rounding; ""
/// if there is none. The range decides on methods, above all `betting`. Mutants (which
/// have their original's declaration), images and ready-made data are not checked.
std::string outside_of_range(const Subject& subject, const Summary& drawn);

/// A channel's declared range; for recorded data the range of their values.
stats::Range range_of(const Question& question, std::size_t subject, std::size_t channel,
                      const stats::Moments& moments);

/// The rounding that a channel declares of its values, and that of their mean in single precision.
double rounding_of(const Question& question, std::size_t subject, std::size_t channel);

/// The value of a subject's first channel that stands for "no point"; only samplers have one.
std::optional<double> no_point_of(const Subject& side);

}  // namespace assay::harness
