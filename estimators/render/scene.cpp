#include "render/scene.h"

#include <embree3/rtcore.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimators/instruction_set.h"

namespace assay::render {

namespace {

[[noreturn]] void embree_failed(const char* message) {
  throw std::runtime_error(std::string("Embree: ") + message);
}

std::string best_isa() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") ? "avx2" : "sse4.2";
#else
  return "sse2";  // Embree's word for the four lanes that every processor has
#endif
}

/// One device for the process: it pins the instruction set. Its own `threads` setting must stay
/// away: Embree would limit oneTBB to that number in the whole process for as long as the device
/// lives.
class Device {
 public:
  Device() : isa_(best_isa()) {
    const std::string settings = "isa=" + isa_ + ",set_affinity=0";
    handle_ = rtcNewDevice(settings.c_str());
    if (!handle_) embree_failed("no device could be made");
  }
  ~Device() { rtcReleaseDevice(handle_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  static const std::shared_ptr<const Device>& shared() {
    static const std::shared_ptr<const Device> device = std::make_shared<const Device>();
    return device;
  }

  RTCDevice handle() const { return handle_; }
  const std::string& isa() const { return isa_; }

  /// An empty scene that keeps the device alive. The scene is then built on the calling thread, so
  /// that the tree does not depend on the number of processors.
  static std::shared_ptr<RTCSceneTy> new_scene() {
    const std::shared_ptr<const Device> device = shared();
    // The deleter holds the device, which must outlive its scenes.
    std::shared_ptr<RTCSceneTy> scene(rtcNewScene(device->handle()),
                                      [device](RTCScene held) { rtcReleaseScene(held); });
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
    return scene;
  }
  /// Throws what Embree has to complain of; it keeps the first error of each thread until asked.
  static void commit(RTCScene scene) {
    {
      const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
      rtcCommitScene(scene);
    }
    // By Embree's numbers.
    constexpr std::array words{"",
                               "unknown error",
                               "invalid argument",
                               "invalid operation",
                               "out of memory",
                               "this processor is not supported",
                               "cancelled"};
    static_assert(RTC_ERROR_CANCELLED + 1 == words.size());
    const RTCError error = rtcGetDeviceError(shared()->handle());
    if (error != RTC_ERROR_NONE) embree_failed(words.at(error));
  }

 private:
  std::string isa_;
  RTCDevice handle_ = nullptr;
};

void put(float* target, const Vector3& v) {
  target[0] = static_cast<float>(v.x);
  target[1] = static_cast<float>(v.y);
  target[2] = static_cast<float>(v.z);
}

struct Layout {
  RTCBufferType type;
  RTCFormat format;
  std::size_t bytes;
};

template <class Element>
Element* new_buffer(RTCGeometry geometry, const Layout& layout, std::size_t count) {
  void* const buffer =
      rtcSetNewGeometryBuffer(geometry, layout.type, 0, layout.format, layout.bytes, count);
  if (!buffer) embree_failed("no memory for a geometry");
  return static_cast<Element*>(buffer);
}

RTCGeometry geometry_of(const TriangleMesh& mesh, RTCDevice device) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  float* vertex =
      new_buffer<float>(geometry, {RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float)},
                        mesh.vertices.size());
  for (const Vector3& v : mesh.vertices) put(std::exchange(vertex, vertex + 3), v);
  unsigned* index = new_buffer<unsigned>(
      geometry, {RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(unsigned)},
      mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) index = std::ranges::copy(triangle, index).out;
  return geometry;
}

RTCGeometry geometry_of(const Disc& disc, RTCDevice device) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  float* const centre = new_buffer<float>(
      geometry, {RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float)}, 1);
  put(centre, disc.centre);
  centre[3] = static_cast<float>(disc.radius);
  float* const normal = new_buffer<float>(
      geometry, {RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3 * sizeof(float)}, 1);
  put(normal, disc.normal);
  return geometry;
}

void attach(RTCScene scene, const Shape& shape, RTCDevice device) {
  const RTCGeometry geometry =
      std::visit([&](const auto& form) { return geometry_of(form, device); }, shape);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace

Scene::Scene(const std::vector<Shape>& shapes) {
  scene_ = Device::new_scene();
  for (const Shape& shape : shapes) attach(scene_.get(), shape, Device::shared()->handle());
  Device::commit(scene_.get());
}

static_assert(offsetof(RTCRay, tnear) == 12 && offsetof(RTCRay, dir_x) == 16 &&
              offsetof(RTCRay, tfar) == 32 && offsetof(RTCRay, mask) == 36);

Hit Scene::closest_hit(const RoundedRay& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query;
  query.ray = std::bit_cast<RTCRay>(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.hit.geomID, query.hit.primID, static_cast<double>(query.ray.tfar)};
}

bool Scene::occluded(const RoundedRay& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = std::bit_cast<RTCRay>(ray);
  rtcOccluded1(scene_.get(), &context, &query);
  return query.tfar < 0;
}

}  // namespace assay::render

namespace assay {

std::string ray_instruction_set() { return render::Device::shared()->isa(); }

}  // namespace assay
