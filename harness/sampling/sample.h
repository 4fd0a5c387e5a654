#pragma once

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
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

class Pool;

/// The reason why a source yields no more numbers: it threw something.
struct Fault {
  std::optional<std::uint64_t> observation = {};  ///< The observation that could not be drawn, if
                                                  ///< drawing began.
  std::string words = "";                         ///< In the source's own words.
};

/// "`darts` stopped in the pilot at observation 17: the lamp burnt out" with `when` " in the
/// pilot".
std::string sentence_of(const Fault& fault, const std::string& estimator,
                        const std::string& when = "");

/// The words of an exception, never empty. An InputError's place stands before them.
std::string words_of(const std::exception_ptr& thrown);

struct BlockSums {
  std::uint64_t count = 0;
  std::vector<stats::Moments> channels = {};
  double seconds = 0;
};

/// The observations of a pool up to a mark, all drawn. The pool must outlive it.
class Drawn {
 public:
  const Pool& pool() const { return *pool_; }
  const Summary& summary() const { return *summary_; }
  std::shared_ptr<const Summary> shared_summary() const { return summary_; }
  /// The kept values of a channel.
  std::span<const double> values(std::size_t channel) const;
  /// Gates on the order of a channel's first kept values (stats::drawn_order_gates). Values that
  /// are not finite have no order.
  const std::vector<stats::Gate>& order_gates(std::size_t channel) const;
  /// The first kept observations, at most `most`, with all channels.
  Observations observations(std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
  /// All blocks drawn so far, also of later observations, if the pool keeps them.
  std::span<const BlockSums> blocks() const;

 private:
  friend class Pool;
  Drawn(const Pool& pool, std::uint64_t count, std::shared_ptr<const Summary> summary)
      : pool_(&pool), count_(count), summary_(std::move(summary)) {}

  const Pool* pool_;
  std::uint64_t count_;
  std::shared_ptr<const Summary> summary_;
};

/// Drawn observations, or the fault that prevented them.
class Sample {
 public:
  Sample(Drawn drawn) : either_(std::move(drawn)) {}  // NOLINT: converts on purpose
  Sample(Fault fault) : either_(std::move(fault)) {}  // NOLINT: converts on purpose

  /// Null if there is a fault.
  const Drawn* drawn() const { return std::get_if<Drawn>(&either_); }
  /// Null if all was drawn.
  const Fault* fault() const { return std::get_if<Fault>(&either_); }

 private:
  std::variant<Drawn, Fault> either_;
};

}  // namespace assay::harness
