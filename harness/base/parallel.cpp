#include "harness/base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace assay::harness {

unsigned threads_of(unsigned given) {
  return given != 0 ? given : static_cast<unsigned>(tbb::info::default_concurrency());
}

void on_all_threads(std::size_t count, const std::function<void(std::size_t)>& work) {
  tbb::parallel_for(std::size_t{0}, count, work);
}

void with_threads(unsigned given, const std::function<void()>& work) {
  const unsigned count = threads_of(given);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
  tbb::task_arena arena(static_cast<int>(count));
  arena.execute(work);
}

}  // namespace assay::harness
