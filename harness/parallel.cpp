#include "harness/parallel.h"

#include <oneapi/tbb/info.h>

#include <ctime>

namespace assay::harness {

unsigned threads_of(unsigned given) {
  return given != 0 ? given : static_cast<unsigned>(tbb::info::default_concurrency());
}

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void on_all_threads(std::size_t count, const std::function<void(std::size_t)>& work) {
  tbb::parallel_for(std::size_t{0}, count, work);
}

}  // namespace assay::harness
