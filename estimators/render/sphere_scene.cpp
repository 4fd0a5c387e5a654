#include "render/sphere_scene.h"

#include <cmath>

#include "render/device.h"

namespace assay::render {

namespace {

// A query in double precision: Embree hands the context it was given on to the callbacks. The
// context comes first, so that a pointer to it is a pointer to the whole.
struct Query {
  RTCIntersectContext context;
  Vector3 origin;
  Vector3 direction;
  bool from_surface = false;
  double far = 0;
  double t = -1;
};

// The larger root of |o + t d|^2 = 1, d of unit length. From the surface |o| = 1 and the other root
// is 0: to say so is exact where computing it is not.
double exit_distance(const Query& query) {
  const double b = dot(query.origin, query.direction);
  if (query.from_surface) return -2 * b;
  return -b + std::sqrt(b * b + 1 - squared_length(query.origin));
}

void bounds(const RTCBoundsFunctionArguments* arguments) {
  // A little more than the sphere: the box must hold the rounded ray's hit, too.
  constexpr float half = 1.001F;
  *arguments->bounds_o = {-half, -half, -half, 0, half, half, half, 0};
}

void intersect(const RTCIntersectFunctionNArguments* arguments) {
  auto* const query = reinterpret_cast<Query*>(arguments->context);
  query->t = exit_distance(*query);
}

void occlude(const RTCOccludedFunctionNArguments* arguments) {
  auto* const query = reinterpret_cast<Query*>(arguments->context);
  const double t = exit_distance(*query);
  if (t > 0 && t < query->far) query->t = t;
}

RTCRay rounded(const Query& query) {
  const auto single = [](double x) { return static_cast<float>(x); };
  RTCRay ray{};
  ray.org_x = single(query.origin.x);
  ray.org_y = single(query.origin.y);
  ray.org_z = single(query.origin.z);
  ray.dir_x = single(query.direction.x);
  ray.dir_y = single(query.direction.y);
  ray.dir_z = single(query.direction.z);
  ray.tfar = 4;  // beyond every point of the sphere
  ray.mask = ~0U;
  return ray;
}

}  // namespace

SphereScene::SphereScene() {
  scene_ = Device::new_scene();
  const RTCDevice device = Device::shared()->handle();
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occlude);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
  Device::commit(scene_.get());
}

Vector3 SphereScene::exit(const Vector3& origin, const Vector3& direction,
                          bool from_surface) const {
  Query query{
      .context = {}, .origin = origin, .direction = direction, .from_surface = from_surface};
  rtcInitIntersectContext(&query.context);
  RTCRayHit ray{};
  ray.ray = rounded(query);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &query.context, &ray);
  // Normalised, so that rounding does not add up along a path.
  return normalised(origin + query.t * direction);
}

bool SphereScene::occluded(const Vector3& from, const Vector3& to) const {
  const double distance = length(to - from);
  Query query{.origin = from,
              .direction = (to - from) / distance,
              .from_surface = true,
              .far = distance * (1 - 1e-9)};
  rtcInitIntersectContext(&query.context);
  RTCRay ray = rounded(query);
  rtcOccluded1(scene_.get(), &query.context, &ray);
  return query.t > 0;
}

}  // namespace assay::render
