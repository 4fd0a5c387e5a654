#pragma once

#include <cstdint>
#include <string>

namespace assay::harness {

/// Where a run says how far it is. Called from one thread.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A phase begins ("pilot", "sampling") with so many primaries to draw, or
  /// ("calibration") runs to make.
  virtual void begin(const std::string& phase, std::uint64_t total) = 0;
  virtual void advance(std::uint64_t done) = 0;  ///< units done so far in this phase
  virtual void end() = 0;
};

/// Says nothing.
class Silence final : public Progress {
 public:
  void begin(const std::string&, std::uint64_t) override {}
  void advance(std::uint64_t) override {}
  void end() override {}
};

}  // namespace assay::harness
