#pragma once

#include <cstdint>
#include <string>

namespace assay::harness {

/// Listens to how far a run is. Called from one thread.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A phase begins: "pilot" or "sampling" with `total` primaries, "calibration" with `total` runs.
  virtual void begin(const std::string& phase, std::uint64_t total) = 0;
  virtual void advance(std::uint64_t done) = 0;  ///< units done so far in this phase
  virtual void end() = 0;
};

class Silence final : public Progress {
 public:
  void begin(const std::string&, std::uint64_t) override {}
  void advance(std::uint64_t) override {}
  void end() override {}
};

}  // namespace assay::harness
