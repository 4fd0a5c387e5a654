#pragma once

// Uses a saved record in place of an estimator: a claim reads its moments, and nothing is drawn.

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "estimators/estimator.h"
#include "harness/sampling/prepare.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

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
  /// Throws std::logic_error: there are no observations.
  std::unique_ptr<Estimator> make() const override;
  std::optional<std::uint64_t> observations() const override { return summary.count; }
  std::optional<Nature> nature() const override { return Nature{.averages = averages}; }
  std::string data_file() const override { return file; }
  std::optional<StreamKey> data_stream() const override { return stream; }
  bool knows_cost(CostKind kind) const;
};

/// The set-up as moments of an earlier run, or null.
const RecordedRun* as_recorded_run(const Setup& setup);

/// Reads `run` and `estimator`. A test is eligible if its claim is about moments of that estimator
/// alone. It takes the one with most channels, then one with moments of costs, then the largest.
/// Costs that were not kept are known if the total divides by the number of observations: each then
/// cost the same. InputError if the record is unreadable, lacks the estimator, or has no eligible
/// test.
std::shared_ptr<const RecordedRun> read_recorded_run(Parameters& parameters);

}  // namespace assay::harness
