#include "harness/base/parallel.h"

#include <oneapi/tbb/info.h>

namespace assay::harness {

unsigned threads_of(unsigned given) {
  return given != 0 ? given : static_cast<unsigned>(tbb::info::default_concurrency());
}

void on_all_threads(std::size_t count, const std::function<void(std::size_t)>& work) {
  tbb::parallel_for(std::size_t{0}, count, work);
}

}  // namespace assay::harness
