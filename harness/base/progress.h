#pragma once

#include <cstdint>
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

}  // namespace assay::harness
