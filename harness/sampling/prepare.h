#pragma once

// Prepares a suite's estimators: finds plugins, checks parameters, makes set-ups.

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "estimators/estimator.h"
#include "harness/suite/suite.h"

namespace assay::harness {

struct PreparedEstimator {
  std::string name;    ///< In the suite; at a point of a sweep with its value.
  std::string listed;  ///< In the suite, without a sweep's value.
  const Entry* entry;
  std::shared_ptr<const Setup> setup;
  std::string parameters;  ///< Canonical, as recorded.
  std::string folder;      ///< Base of relative file names.
  std::string key_plugin;  ///< Owner of the streams: a mutant uses its original's.
  std::string key_parameters;
  std::optional<std::uint64_t> primaries;  ///< Given in the suite; nullopt: auto.
  std::shared_ptr<const Setup> original;   ///< A mutant's original at the same parameters.
  Location where;
  Value given = {};  ///< Given in the suite.

  /// Says whether a secondary is the mean of its primaries, and how it is biased if that is known.
  Nature nature() const;
};
using Estimators = std::map<std::string, PreparedEstimator>;  ///< By their names in the suite.

/// InputError with plugin, parameter and place for anything that a plugin refuses.
PreparedEstimator prepare(const EstimatorEntry& entry, const std::string& folder);

/// Sides of `paired` claims draw the random numbers of the first of those that they are paired
/// with, directly or through others.
void share_random_numbers(const Suite& suite, Estimators& prepared);

/// The key of an estimator's stream. `copy` is 1 for a claim's second source with the same key.
/// `purpose` separates the pilot and each sampler.
StreamKey key_of(const PreparedEstimator& estimator, std::uint64_t seed, std::uint32_t copy,
                 const std::string& purpose);

/// A key in the record: 16 hexadecimal digits. nullopt if the text is something else.
std::string stream_text(StreamKey key);
std::optional<StreamKey> read_stream(const std::string& text);

}  // namespace assay::harness
