#pragma once

// The one Embree device of the process; only files that already know Embree include this.

#include <embree3/rtcore.h>

#include <memory>
#include <string>

namespace assay::render {

[[noreturn]] void embree_failed(const char* message);

/// One device for the process: it pins the instruction set. Its own `threads` setting must stay
/// away: Embree would limit oneTBB to that number in the whole process for as long as the device
/// lives.
class Device {
 public:
  Device();
  ~Device() { rtcReleaseDevice(handle_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  static const std::shared_ptr<const Device>& shared();

  RTCDevice handle() const { return handle_; }
  const std::string& isa() const { return isa_; }

  /// Throws what Embree has to complain of; it keeps the first error of each thread until asked.
  void check() const;

  /// An empty scene that keeps the device alive. The scene is then built on the calling thread, so
  /// that the tree does not depend on the number of processors.
  static std::shared_ptr<RTCSceneTy> new_scene();
  static void commit(RTCScene scene);

 private:
  std::string isa_;
  RTCDevice handle_ = nullptr;
};

}  // namespace assay::render
