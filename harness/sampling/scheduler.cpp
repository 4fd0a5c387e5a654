#include "harness/sampling/scheduler.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "harness/base/interrupt.h"
#include "harness/base/parallel.h"

namespace assay::harness {
namespace {

struct Task {
  std::size_t pool;
  std::uint64_t first;
  std::uint64_t last;
};

struct DrawnBlock {
  std::size_t pool;
  std::shared_ptr<Pool::Block> block;  // shared because a pipeline copies its items
};

/// The blocks still to draw, pool by pool. Pools that are compared by their seconds come last,
/// interleaved: a machine that slows down then slows all of them. Interleaving every pool would
/// leave workers idle, since blocks are folded in order. A failed pool gets no more blocks: each
/// may take a time-out. Handing out and folding are concurrent, so the list cannot ask the pool
/// itself.
class TaskList {
 public:
  explicit TaskList(const std::vector<std::shared_ptr<Pool>>& pools)
      : pools_(pools), in_trouble_(pools.size()) {
    for (std::size_t i = 0; i < pools.size(); ++i) {
      in_trouble_[i] = pools[i]->fault().has_value();
      begun_.push_back(pools[i]->drawn());
    }
    next_ = begun_;
  }

  void note_trouble(std::size_t pool) { in_trouble_[pool] = true; }

  bool next(Task& task) {
    const std::optional<std::size_t> pool = next_pool();
    if (!pool) return false;
    task = {*pool, next_[*pool], pools_[*pool]->block_end(next_[*pool])};
    next_[*pool] = task.last;
    return true;
  }

 private:
  std::optional<std::size_t> next_pool() const {
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < pools_.size(); ++i) {
      if (in_trouble_[i] || next_[i] >= pools_[i]->requested()) continue;
      if (!pools_[i]->keeps_blocks()) return i;
      if (!last || share_of(i) < share_of(*last)) last = i;
    }
    return last;
  }

  double share_of(std::size_t pool) const {
    return static_cast<double>(next_[pool] - begun_[pool]) /
           static_cast<double>(pools_[pool]->requested() - begun_[pool]);
  }

  const std::vector<std::shared_ptr<Pool>>& pools_;
  std::vector<std::atomic<bool>> in_trouble_;
  std::vector<std::uint64_t> begun_;
  std::vector<std::uint64_t> next_;
};

/// A worker's estimators, each made at its first use.
class Workers {
 public:
  explicit Workers(const std::vector<std::shared_ptr<Pool>>& pools) : pools_(pools) {}

  Estimator& estimator(std::size_t pool) {
    auto& mine = estimators_.local();
    mine.resize(pools_.size());
    if (!mine[pool]) mine[pool] = pools_[pool]->setup()->make();
    return *mine[pool];
  }

 private:
  const std::vector<std::shared_ptr<Pool>>& pools_;
  tbb::enumerable_thread_specific<std::vector<std::unique_ptr<Estimator>>> estimators_;
};

/// Blocks in flight. Each has sums of every channel, so large images get only one for each worker.
std::size_t under_way(const std::vector<std::shared_ptr<Pool>>& pools, unsigned workers) {
  constexpr std::size_t many_channels = std::size_t{1} << 16;
  const bool large =
      std::ranges::any_of(pools, [](const auto& pool) { return pool->channels() > many_channels; });
  return large ? workers : std::size_t{8} * workers;
}

std::uint64_t work(const Pool& pool, std::uint64_t observations) {
  return observations * pool.primaries();
}

}  // namespace

void draw_all(const std::vector<std::shared_ptr<Pool>>& pools, const Drawing& drawing,
              Progress& progress) {
  const unsigned count = threads_of(drawing.threads);
  std::uint64_t total = 0;
  for (const auto& pool : pools) total += work(*pool, pool->requested() - pool->drawn());
  progress.begin({.name = drawing.phase, .total = total});

  TaskList tasks(pools);
  Workers workers(pools);
  std::uint64_t done = 0;
  const auto hand_out = [&](tbb::flow_control& control) {
    Task task{};
    if (interrupted() || !tasks.next(task)) control.stop();
    return task;
  };
  const auto draw = [&](const Task& task) {
    const auto estimator = [&]() -> Estimator& { return workers.estimator(task.pool); };
    return DrawnBlock{task.pool, std::make_shared<Pool::Block>(
                                     pools[task.pool]->draw(estimator, task.first, task.last))};
  };
  const auto fold = [&](const DrawnBlock& drawn) {
    done += work(*pools[drawn.pool], drawn.block->whole.count);
    pools[drawn.pool]->fold(std::move(*drawn.block));
    if (pools[drawn.pool]->fault()) tasks.note_trouble(drawn.pool);
    progress.advance(done);
  };
  with_threads(drawing.threads, [&] {
    tbb::parallel_pipeline(
        under_way(pools, count),
        tbb::make_filter<void, Task>(tbb::filter_mode::serial_in_order, hand_out) &
            tbb::make_filter<Task, DrawnBlock>(tbb::filter_mode::parallel, draw) &
            tbb::make_filter<DrawnBlock, void>(tbb::filter_mode::serial_in_order, fold));
    for (const auto& pool : pools) pool->end_drawing();
  });
  progress.end();
}

}  // namespace assay::harness
