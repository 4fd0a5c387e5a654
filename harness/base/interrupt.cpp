#include "harness/base/interrupt.h"

#include <atomic>
#include <csignal>
#include <stdexcept>

namespace assay::harness {

namespace {

std::atomic<bool> asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may write nothing else");

extern "C" void note_interrupt(int) { asked.store(true); }

bool is_ignored(int signal) {
  struct sigaction action {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler == SIG_IGN;
}

void watch(int signal) {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  sigemptyset(&action.sa_mask);
  // The handler is removed as it runs, so that a second Ctrl-C always works.
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void watch_interrupts() {
  asked.store(false);
  watch(SIGINT);
  // Whoever runs this for others, a CI job or a batch system, ends it so: programs that it started
  // must not outlive it.
  watch(SIGTERM);
  if (!is_ignored(SIGHUP)) watch(SIGHUP);
  // A file beyond its limit is an error of the write, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return asked.load(); }

void stop_if_interrupted() {
  if (interrupted()) throw std::runtime_error("interrupted; nothing is written");
}

}  // namespace assay::harness
