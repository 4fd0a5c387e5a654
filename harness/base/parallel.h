#pragma once

#include <cstddef>
#include <functional>

namespace assay::harness {

/// `given`, or the number of cores if it is 0.
unsigned threads_of(unsigned given);

/// stats::ForEach on all threads of the caller's arena.
void on_all_threads(std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls `work` in its own arena of so many threads, also if the calling thread is in another one.
void with_threads(unsigned given, const std::function<void()>& work);

}  // namespace assay::harness
