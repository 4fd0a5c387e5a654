#include "harness/sampling/executor.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include <algorithm>

namespace assay::harness {
namespace {

/// Blocks in flight. Each has sums of every channel, so large images get only one for each worker.
std::size_t under_way(const SomePools& pools, unsigned workers) {
  constexpr std::size_t many_channels = std::size_t{1} << 16;
  const bool large =
      std::ranges::any_of(pools, [](const auto& pool) { return pool->channels() > many_channels; });
  return large ? workers : std::size_t{8} * workers;
}

class Threads final : public Executor {
 public:
  explicit Threads(unsigned count) : count_(count) {}

  void draw(Round& round) override {
    struct DrawnBlock {
      Task task;
      std::shared_ptr<Pool::Block> block;  // shared because a pipeline copies its items
    };
    const DrawBlock draw_block = drawing_of(round.pools());
    const auto hand_out = [&](tbb::flow_control& control) {
      const std::optional<Task> task = round.next();
      if (!task) control.stop();
      return task.value_or(Task{});
    };
    const auto draw = [&](const Task& task) {
      return DrawnBlock{task, std::make_shared<Pool::Block>(draw_block(task))};
    };
    const auto fold = [&](const DrawnBlock& drawn) {
      round.fold(drawn.task, std::move(*drawn.block));
    };
    with_threads(count_, [&] {
      tbb::parallel_pipeline(
          under_way(round.pools(), threads_of(count_)),
          tbb::make_filter<void, Task>(tbb::filter_mode::serial_in_order, hand_out) &
              tbb::make_filter<Task, DrawnBlock>(tbb::filter_mode::parallel, draw) &
              tbb::make_filter<DrawnBlock, void>(tbb::filter_mode::serial_in_order, fold));
      for (const auto& pool : round.pools()) pool->end_drawing();
    });
  }

 private:
  unsigned count_;
};

}  // namespace

Round::Round(const SomePools& pools, Progress& progress, const std::string& phase)
    : pools_(pools), progress_(progress), in_trouble_(pools.size()) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < pools.size(); ++i) {
    const Pool& pool = *pools[i];
    in_trouble_[i] = pool.fault().has_value();
    begun_.push_back(pool.drawn());
    total += (std::max(pool.requested(), pool.drawn()) - pool.drawn()) * pool.primaries();
  }
  next_ = begun_;
  progress.begin({.name = phase, .total = total});
}

std::optional<Task> Round::next() {
  const std::optional<std::size_t> pool = interrupted() ? std::nullopt : next_pool();
  if (!pool) return std::nullopt;
  const Task task{*pool, next_[*pool], pools_[*pool]->block_end(next_[*pool])};
  next_[*pool] = task.last;
  return task;
}

/// Pools go out one by one. Those that are compared by their seconds come last, interleaved: a
/// machine that slows down then slows all of them. Interleaving every pool would leave workers
/// idle, since blocks are folded in order. A failed pool gets no more blocks: each may take a
/// time-out.
std::optional<std::size_t> Round::next_pool() const {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < pools_.size(); ++i) {
    if (in_trouble_[i] || next_[i] >= pools_[i]->requested()) continue;
    if (!pools_[i]->keeps_blocks()) return i;
    if (!last || share_of(i) < share_of(*last)) last = i;
  }
  return last;
}

std::uint64_t Round::blocks_left() const {
  std::uint64_t blocks = 0;
  for (std::size_t i = 0; i < pools_.size(); ++i) {
    const std::uint64_t end = pools_[i]->requested();
    const std::uint64_t size = pools_[i]->block_size();
    if (!in_trouble_[i] && next_[i] < end) blocks += (end - next_[i] + size - 1) / size;
  }
  return blocks;
}

double Round::share_of(std::size_t pool) const {
  return static_cast<double>(next_[pool] - begun_[pool]) /
         static_cast<double>(pools_[pool]->requested() - begun_[pool]);
}

void Round::fold(const Task& task, Pool::Block&& block) {
  Pool& pool = *pools_[task.pool];
  done_ += block.whole.count * pool.primaries();
  pool.fold(std::move(block));
  // Handing out is concurrent and cannot ask the pool itself.
  if (pool.fault()) in_trouble_[task.pool] = true;
  progress_.advance(done_);
  for (const auto& act : after_fold_) act();
}

DrawBlock drawing_of(const SomePools& pools) {
  using Made = std::vector<std::unique_ptr<Estimator>>;
  const auto of_threads = std::make_shared<tbb::enumerable_thread_specific<Made>>();
  return [&pools, of_threads](const Task& task) {
    const auto estimator = [&]() -> Estimator& {
      Made& mine = of_threads->local();
      mine.resize(pools.size());
      if (!mine[task.pool]) mine[task.pool] = pools[task.pool]->setup()->make();
      return *mine[task.pool];
    };
    return pools[task.pool]->draw(estimator, task.first, task.last);
  };
}

std::shared_ptr<Executor> threads(unsigned count) { return std::make_shared<Threads>(count); }

std::shared_ptr<Executor> executor_of(const RunOptions& options) {
  return options.executor ? options.executor : threads(options.threads);
}

void draw_all(const SomePools& pools, Executor& executor, const std::string& phase,
              Progress& progress) {
  executor.recall(pools);
  Round round(pools, progress, phase);
  executor.draw(round);
}

}  // namespace assay::harness
