#pragma once

// The sources a claim names, found among the prepared estimators.

#include <map>
#include <string>
#include <vector>

#include "harness/question/question.h"

namespace assay::harness {

using Estimators = std::map<std::string, PreparedEstimator>;

/// The estimator a source names. InputError, with a near name, where the suite has none.
const PreparedEstimator& estimator_of(const Source& source, const Estimators& estimators);

/// The estimator's secondary estimates: all channels that are tested, or the one the part names.
Subject estimates(const Source& source, const PreparedEstimator& estimator);
Subject estimates(const Source& source, const Estimators& estimators);

/// A sampler's draws: cells of the whole domain, all marginals, or whether they are consistent. Of
/// marginals the part may name one.
enum class Draws { cells, marginals, consistency };
Subject draws(const Source& source, const Estimators& estimators, Draws what);

/// A distribution's source: a channel where the part names one, else a sampler.
Subject values(const Source& source, const Estimators& estimators);

/// What the plugin knows of a channel. InputError where it knows nothing.
Constant analytic_mean(const Channel& channel, const Source& source);
Constant analytic_variance(const Channel& channel, const Source& source);

/// The stream that a subject's observations are or were drawn from.
StreamKey stream_of(const Subject& subject, std::uint64_t seed);

/// InputError at the claim where it asks of a run's moments what moments do not tell.
void require_moments_suffice(const Question& question);

}  // namespace assay::harness
