#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <cstddef>
#include <functional>

#include "estimators/core/thread_seconds.h"

namespace assay::harness {

/// `given`, or the number of cores if it is 0.
unsigned threads_of(unsigned given);

/// stats::ForEach on all threads of the caller's arena.
void on_all_threads(std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls `work` in its own arena of so many threads, also if the calling thread is in another one.
template <class Work>
auto with_threads(unsigned given, const Work& work) {
  const unsigned count = threads_of(given);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
  tbb::task_arena arena(static_cast<int>(count));
  return arena.execute(work);
}

}  // namespace assay::harness
