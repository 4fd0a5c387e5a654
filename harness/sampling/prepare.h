#pragma once

// Prepares a suite's estimators: finds plugins, checks parameters, makes set-ups.

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "estimators/estimator.h"
#include "harness/sampling/summary.h"
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

// ---- A saved record in place of an estimator: a claim reads its moments, and nothing is drawn.

/// One estimator of a record (`recorded` with `run` and `estimator`): the moments of its
/// secondaries, all channels from one test.
class RecordedRun final : public Setup {
 public:
  std::string file = {};
  std::vector<std::string> names = {};  ///< of the channels
  Summary summary = Summary();
  std::uint64_t primaries = 1;
  bool averages = false;  ///< variance falls like 1 / primaries
  std::optional<StreamKey> stream = {};
  /// By CountedCost: true if the joint moments of value and cost are known.
  std::array<bool, counted_costs> known_costs = {};

  std::size_t channel_count() const override { return names.size(); }
  Channel channel(std::size_t place) const override { return {.name = names[place]}; }
  std::unique_ptr<Estimator> make() const override {
    throw std::logic_error("a recorded run has moments, not observations");
  }
  std::optional<std::uint64_t> observations() const override { return summary.count; }
  std::optional<Nature> nature() const override { return Nature{.averages = averages}; }
  std::string data_file() const override { return file; }
  std::optional<StreamKey> data_stream() const override { return stream; }
  bool knows_cost(CostKind kind) const {
    return kind != CostKind::seconds &&
           known_costs[kind == CostKind::rays ? rays_cost : samples_cost];
  }
};

const RecordedRun* as_recorded_run(const Setup& setup);

}  // namespace assay::harness
