#pragma once

// A sample: what was drawn of one source, or why it could not be drawn.

#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"
#include "stats/basics/moments.h"

namespace assay::harness {

class Pool;

/// Why a source yields no more numbers. A source fails where it throws, whatever it throws.
struct Fault {
  std::optional<std::uint64_t> observation = {};  ///< which could not be drawn, if it came so far
  std::string words = "";                         ///< the source's own
};

/// "`darts` stopped in the pilot at observation 17: the lamp burnt out" with `when` " in the pilot".
std::string sentence_of(const Fault& fault, const std::string& estimator,
                        const std::string& when = "");

/// The words of an exception. An InputError's place stands before them. An exception without words
/// gets some.
std::string words_of(const std::exception_ptr& thrown);

/// One block of observations by itself.
struct BlockSums {
  std::uint64_t count = 0;
  std::vector<stats::Moments> channels = {};
  double seconds = 0;
};

/// The first observations of a pool up to a marked count, all of them drawn. A pool outlives what
/// it hands out.
class Drawn {
 public:
  const Pool& pool() const { return *pool_; }
  const Summary& summary() const { return *summary_; }
  std::shared_ptr<const Summary> shared_summary() const { return summary_; }
  /// The values of a channel, as many as were to be kept.
  std::span<const double> values(std::size_t channel) const;
  /// The first observations, all channels, at most `most` and as many as were to be kept.
  Observations observations(std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
  /// The blocks drawn so far, those of later observations too, where the pool keeps them.
  std::span<const BlockSums> blocks() const;

 private:
  friend class Pool;
  Drawn(const Pool& pool, std::uint64_t count, std::shared_ptr<const Summary> summary)
      : pool_(&pool), count_(count), summary_(std::move(summary)) {}

  const Pool* pool_;
  std::uint64_t count_;
  std::shared_ptr<const Summary> summary_;
};

/// Numbers can be reached where they exist, and only there.
class Sample {
 public:
  Sample(Drawn drawn) : either_(std::move(drawn)) {}  // NOLINT: converts on purpose
  Sample(Fault fault) : either_(std::move(fault)) {}  // NOLINT: converts on purpose

  /// Null where there is a fault.
  const Drawn* drawn() const { return std::get_if<Drawn>(&either_); }
  /// Null where all was drawn.
  const Fault* fault() const { return std::get_if<Fault>(&either_); }

 private:
  std::variant<Drawn, Fault> either_;
};

}  // namespace assay::harness
