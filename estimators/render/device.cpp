#include "render/device.h"

#include <oneapi/tbb/global_control.h>

#include <stdexcept>

namespace assay::render {

void embree_failed(const char* message) {
  throw std::runtime_error(std::string("Embree: ") + message);
}

namespace {

std::string best_isa() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") ? "avx2" : "sse4.2";
#else
  return "sse2";  // Embree's word for the four lanes that every processor has
#endif
}

}  // namespace

Device::Device() : isa_(best_isa()) {
  const std::string settings = "isa=" + isa_ + ",set_affinity=0";
  handle_ = rtcNewDevice(settings.c_str());
  if (!handle_) embree_failed("no device could be made");
}

const std::shared_ptr<const Device>& Device::shared() {
  static const std::shared_ptr<const Device> device = std::make_shared<const Device>();
  return device;
}

void Device::check() const {
  switch (rtcGetDeviceError(handle_)) {
    case RTC_ERROR_NONE:
      return;
    case RTC_ERROR_INVALID_ARGUMENT:
      embree_failed("invalid argument");
    case RTC_ERROR_INVALID_OPERATION:
      embree_failed("invalid operation");
    case RTC_ERROR_OUT_OF_MEMORY:
      embree_failed("out of memory");
    case RTC_ERROR_UNSUPPORTED_CPU:
      embree_failed("this processor is not supported");
    default:
      embree_failed("unknown error");
  }
}

std::shared_ptr<RTCSceneTy> Device::new_scene() {
  const std::shared_ptr<const Device> device = shared();
  // The deleter holds the device, which must outlive its scenes.
  std::shared_ptr<RTCSceneTy> scene(rtcNewScene(device->handle()),
                                    [device](RTCScene held) { rtcReleaseScene(held); });
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void Device::commit(RTCScene scene) {
  {
    const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    rtcCommitScene(scene);
  }
  shared()->check();
}

}  // namespace assay::render
