#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/question/question.h"

namespace assay::harness {

using Estimators = std::map<std::string, PreparedEstimator>;

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

/// The stream of a subject's observations.
StreamKey stream_of(const Subject& subject, std::uint64_t seed);

/// InputError at the claim if it needs more of a recorded run than moments.
void require_moments_suffice(const Question& question);

}  // namespace assay::harness
