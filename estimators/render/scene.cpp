#include "render/scene.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "render/device.h"

namespace assay::render {

namespace {

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

std::string isa() { return Device::shared()->isa(); }

}  // namespace assay::render
