#pragma once

// A suite's estimators made ready: plugins found, parameters checked, set-ups prepared.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "harness/suite/suite.h"

namespace assay::harness {

struct PreparedEstimator {
  std::string name;    ///< in the suite; of a point of a sweep with the value it has there
  std::string listed;  ///< in the suite
  const Entry* entry;
  std::shared_ptr<const Setup> setup;
  std::string parameters;  ///< canonical, as recorded
  std::string folder;      ///< what file names in them are relative to
  std::string key_plugin;  ///< whose streams are used: a mutant's are its original's
  std::string key_parameters;
  std::optional<std::uint64_t> primaries;  ///< as the suite says; nullopt: auto
  std::shared_ptr<const Setup> original;   ///< of a mutant: its original at the same parameters
  Location where;
  Value given = {};  ///< the parameters as the suite gives them

  /// Whether a secondary estimate is the mean of its primaries; how it is biased, if that is known.
  Nature nature() const;
};

/// The names of the parameters an estimator's streams depend on.
std::vector<std::string> parameter_names(const Information&);

/// InputError naming plugin, parameter and place for anything a plugin refuses.
PreparedEstimator prepare(const EstimatorEntry& entry, const std::string& folder);

/// All estimators of a suite by name.
std::map<std::string, PreparedEstimator> prepare_all(const Suite& suite);

/// The key of an estimator's stream. `copy` tells apart: 0 the first source of a claim, 1 a second
/// one of the same key. `purpose` keeps the pilot and each sampler to streams of their own.
StreamKey key_of(const PreparedEstimator& estimator, std::uint64_t seed, std::uint32_t copy,
                 const std::string& purpose);

}  // namespace assay::harness
