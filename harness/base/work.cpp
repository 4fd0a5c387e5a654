#include "harness/base/work.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <csignal>
#include <stdexcept>

namespace assay::harness {

namespace {

std::atomic<bool> was_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may write nothing else");

extern "C" void note_interrupt(int) { was_asked.store(true); }

void watch(int signal) {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  sigemptyset(&action.sa_mask);
  // The handler removes itself as it runs, so that a second Ctrl-C always works.
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(signal, &action, nullptr);
}

}  // namespace

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

void watch_interrupts() {
  was_asked.store(false);
  watch(SIGINT);
  // CI jobs and batch systems send SIGTERM: programs that this one started must not outlive it.
  watch(SIGTERM);
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  if (hang_up.sa_handler != SIG_IGN) watch(SIGHUP);
  // A write beyond the file size limit then fails as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return was_asked.load(); }

void stop_if_interrupted() {
  if (interrupted()) throw std::runtime_error("interrupted; no report is written");
}

}  // namespace assay::harness
