#pragma once

// Work that takes time: how far it is, its threads, and the user's wish to stop it.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace assay::harness {

/// A part of a run that takes time.
struct Phase {
  std::string name = "";    ///< "pilot"
  std::uint64_t total = 0;  ///< units that it takes
  std::string unit = "";    ///< "claims": the units are shown; "": only what part of them is done
};

/// Listens to how far a run is; this one shows nothing. Called from one thread.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void begin(const Phase& /*phase*/) {}
  virtual void advance(std::uint64_t /*done*/) {}  ///< units done so far in this phase
  virtual void end() {}
};
/// Shows nothing. It has no state.
inline Progress silence;

/// `given`, or the number of cores if it is 0.
unsigned threads_of(unsigned given);

/// stats::ForEach on all threads of the caller's arena.
void on_all_threads(std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls `work` in its own arena of so many threads, also if the calling thread is in another one.
void with_threads(unsigned given, const std::function<void()>& work);

/// The first SIGINT, SIGTERM or SIGHUP from now on sets the flag that interrupted() reads. A second
/// one ends the process at once. A hang-up that nohup ignores stays ignored.
void watch_interrupts();

/// True if the user asked to stop. Anything that takes long polls it.
bool interrupted();

/// Throws std::runtime_error if the user asked to stop: pools are short then and must not be read.
void stop_if_interrupted();

}  // namespace assay::harness
