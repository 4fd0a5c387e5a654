#pragma once

// Executors draw the blocks of pools. Blocks are handed out in one order and folded in it. So the
// contents of pools do not depend on who drew them, nor on how many did.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/work.h"
#include "harness/sampling/pool.h"
#include "harness/suite/run_options.h"

namespace assay::harness {

using SomePools = std::vector<std::shared_ptr<Pool>>;

/// A block to draw: observations [first, last) of a pool, by its place among some pools.
struct Task {
  std::size_t pool;
  std::uint64_t first;
  std::uint64_t last;
};

/// The blocks that pools lack up to their requests. One thread at a time may call next(), and one
/// fold().
class Round {
 public:
  /// Ends the progress's phase at its own end.
  Round(const SomePools& pools, Progress& progress, const std::string& phase);
  ~Round() { progress_.end(); }
  Round(const Round&) = delete;
  Round& operator=(const Round&) = delete;

  const SomePools& pools() const { return pools_; }
  /// The next block to draw; nullopt after the last, and when the user interrupts.
  std::optional<Task> next();
  std::uint64_t blocks_left() const;
  /// Adds a drawn block to its pool. Blocks come in the order of next().
  void fold(const Task& task, Pool::Block&& block);
  void after_fold(std::function<void()> act) { after_fold_.push_back(std::move(act)); }

 private:
  std::optional<std::size_t> next_pool() const;
  double share_of(std::size_t pool) const;

  const SomePools& pools_;
  Progress& progress_;
  std::vector<std::atomic<bool>> in_trouble_;
  std::vector<std::uint64_t> begun_;
  std::vector<std::uint64_t> next_;
  std::uint64_t done_ = 0;
  std::vector<std::function<void()>> after_fold_ = {};
};

/// Draws blocks of these pools on threads. Each has estimators of its own, made at their first use.
using DrawBlock = std::function<Pool::Block(const Task&)>;
DrawBlock drawing_of(const SomePools& pools);

/// Set-ups by names that are the same in every process of a run.
using NamedSetups = std::vector<std::pair<std::string, std::shared_ptr<const Setup>>>;

class Executor {
 public:
  virtual ~Executor() = default;
  /// Hears, once, of the set-ups whose pools will be drawn.
  virtual void introduce(const NamedSetups&) {}
  /// Gives pools what is known of them. Called before each round.
  virtual void recall(const SomePools&) {}
  /// Draws all blocks of a round. Stops early, leaving pools short, when the user interrupts.
  virtual void draw(Round& round) = 0;
};

/// The threads of this process; 0: all cores.
std::shared_ptr<Executor> threads(unsigned count = 0);
std::shared_ptr<Executor> executor_of(const RunOptions& options);

void draw_all(const SomePools& pools, Executor& executor, const std::string& phase,
              Progress& progress);

}  // namespace assay::harness
