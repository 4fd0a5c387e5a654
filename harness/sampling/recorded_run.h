#pragma once

// Moments of an earlier run as a source of a claim: a saved record stands where an estimator would,
// and nothing is drawn.

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "estimators/estimator.h"
#include "harness/sampling/prepare.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

/// One estimator of a record (`recorded` with `run` and `estimator`): the moments of its secondary
/// estimates, all channels of one test of the record together.
class RecordedRun final : public Setup {
 public:
  struct Contents {
    std::string file = {};
    std::vector<std::string> channels = {};
    Summary summary = Summary();
    std::uint64_t primaries = 1;
    bool averages = false;  ///< variance falls like 1 / primaries
    std::optional<StreamKey> stream = {};
    /// By CountedCost: whether the joint moments of value and cost are known.
    std::array<bool, counted_costs> knows_cost = {};
  };
  explicit RecordedRun(Contents contents);

  std::vector<Channel> channels() const override;
  /// Throws std::logic_error: there are no observations.
  std::unique_ptr<Estimator> make() const override;
  std::optional<std::uint64_t> observations() const override { return contents_.summary.count; }
  std::string data_file() const override { return contents_.file; }
  std::optional<StreamKey> data_stream() const override { return contents_.stream; }

  const Summary& summary() const { return contents_.summary; }
  std::uint64_t primaries() const { return contents_.primaries; }
  bool knows_cost(CostKind kind) const;
  /// That of `recorded`, but for what is known of averaging.
  const Entry& entry() const { return entry_; }

 private:
  Contents contents_;
  Entry entry_;
};

/// The set-up as moments of an earlier run; null where it is anything else.
const RecordedRun* as_recorded_run(const Setup& setup);

/// Reads `run` and `estimator`. Of the record's tests whose claims are about moments of that
/// estimator alone it takes the one with the most channels, of these one that kept moments of
/// costs, of these the largest. Where costs were not kept, they are known if every observation must
/// have cost the same: the total divides by their number. InputError where the record cannot be
/// read or has no such estimator, or where no test kept its moments.
std::shared_ptr<const RecordedRun> read_recorded_run(Parameters& parameters);

}  // namespace assay::harness
