// The cost of an estimator beside the bare calls of Embree that it must make.
//
// A rectangle shines on a receiver past a sphere of 2,000 triangles. The program times the
// estimator's primaries, for shadow rays and for closest-hit rays. It times the same number of bare
// calls on a like scene along directions made beforehand. Rows: nanoseconds a primary, a bare ray,
// and rays a second relative to bare.

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "estimators/catalogue.h"
#include "estimators/core/value.h"
#include "estimators/instruction_set.h"
#include "paths/worlds.h"
#include "render/hemisphere.h"
#include "render/triangle_mesh.h"

namespace {

using namespace assay;
using render::Vector3;

constexpr unsigned meridians = 40;
constexpr unsigned parallels = 26;  // 2 * 40 * 25 = 2,000 triangles

struct Sphere {
  Vector3 centre;
  double radius;
};

std::filesystem::path write_sphere(const Sphere& sphere) {
  const auto& [centre, radius] = sphere;
  const auto file = std::filesystem::temp_directory_path() / "assay_rays_bench.obj";
  std::ofstream out(file);
  const auto vertex = [&out, &at_centre = centre](double z, double r, double v) {
    const double phi = 2 * std::numbers::pi * v;
    out << "v " << at_centre.x + r * std::cos(phi) << ' ' << at_centre.y + r * std::sin(phi) << ' '
        << at_centre.z + z << '\n';
  };
  vertex(radius, 0, 0);
  vertex(-radius, 0, 0);
  for (unsigned i = 1; i < parallels; ++i) {
    const double theta = std::numbers::pi * i / parallels;
    for (unsigned j = 0; j < meridians; ++j) {
      vertex(radius * std::cos(theta), radius * std::sin(theta), double(j) / meridians);
    }
  }
  const auto at = [](unsigned i, unsigned j) { return 3 + (i - 1) * meridians + j % meridians; };
  for (unsigned j = 0; j < meridians; ++j) {
    out << "f 1 " << at(1, j) << ' ' << at(1, j + 1) << '\n';
    out << "f 2 " << at(parallels - 1, j + 1) << ' ' << at(parallels - 1, j) << '\n';
    for (unsigned i = 1; i + 1 < parallels; ++i) {
      out << "f " << at(i, j) << ' ' << at(i + 1, j) << ' ' << at(i + 1, j + 1) << ' '
          << at(i, j + 1) << '\n';
    }
  }
  return file;
}

// Processor time, which other programs on the machine lengthen least; the best of nine.
double nanoseconds(std::uint64_t count, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 9; ++repeat) {
    const std::clock_t start = std::clock();
    work();
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    best = std::min(best, 1e9 * seconds / static_cast<double>(count));
  }
  return best;
}

/// Nanoseconds of an observation of 256 primaries, and the rays that it counts.
struct Observed {
  double time;
  double rays;
};
Observed observed(const char* plugin, const Value& scene, std::uint64_t observations) {
  const Entry& entry = find_plugin(plugin, {});
  Parameters parameters(plugin, entry.information.parameters, Value::map({{"scene", scene}}), "");
  const auto setup = entry.prepare(parameters);
  const auto estimator = setup->make();
  const StreamKey key = stream_key(1, plugin, parameters.canonical(), 0);
  std::vector<double> out(setup->channels().size());
  Cost cost;
  const double time = nanoseconds(observations, [&] {
    cost = {};
    for (std::uint64_t i = 0; i < observations; ++i) {
      Stream random(key, i);
      estimator->secondary(random, 256, out, cost);
    }
  });
  if (!std::isfinite(out[0])) std::puts("not finite");
  return {time, static_cast<double>(cost.rays()) / static_cast<double>(observations)};
}

// Embree called directly, with the device and scene settings of render/scene.cpp.
class Bare {
 public:
  explicit Bare(const std::vector<render::TriangleMesh>& meshes)
      : device_(rtcNewDevice(("isa=" + ray_instruction_set() + ",threads=1").c_str())),
        scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    for (const render::TriangleMesh& mesh : meshes) attach(mesh);
    rtcCommitScene(scene_);
  }
  ~Bare() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Bare(const Bare&) = delete;
  Bare& operator=(const Bare&) = delete;

  double occluded_time(const std::vector<RTCRay>& rays) const {
    return ray_time([&](std::uint64_t i, RTCIntersectContext& context) {
      RTCRay ray = rays[i % rays.size()];
      rtcOccluded1(scene_, &context, &ray);
      return ray.tfar < 0;
    });
  }

  double intersect_time(const std::vector<RTCRay>& rays) const {
    return ray_time([&](std::uint64_t i, RTCIntersectContext& context) {
      RTCRayHit query;
      query.ray = rays[i % rays.size()];
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &query);
      return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    });
  }

 private:
  /// `hits` tells whether ray `i` hits.
  template <class Hits>
  static double ray_time(const Hits& hits) {
    constexpr std::uint64_t count = 1'000'000;
    unsigned hit = 0;
    const double time = nanoseconds(count, [&] {
      for (std::uint64_t i = 0; i < count; ++i) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        hit += hits(i, context);
      }
    });
    if (hit == 0) std::puts("nothing hit");
    return time;
  }

  void attach(const render::TriangleMesh& mesh) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertices.size()));
    for (const Vector3& p : mesh.vertices) {
      for (const double x : {p.x, p.y, p.z}) *v++ = static_cast<float>(x);
    }
    auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) t = std::copy(triangle.begin(), triangle.end(), t);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCScene scene_;
};

RTCRay bare_ray(const Vector3& direction, double far) {
  RTCRay ray{};
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tnear = 1e-4f;
  ray.tfar = static_cast<float>(far);
  ray.mask = ~0u;
  return ray;
}

std::vector<RTCRay> rays_by(const std::function<RTCRay(double, double)>& make) {
  std::vector<RTCRay> rays;
  Stream random(stream_key(1, "rays_bench", "", 0), 0);
  while (rays.size() < (1u << 18)) {
    const double u = random.uniform();
    const double v = random.uniform();
    rays.push_back(make(u, v));
  }
  return rays;
}

void print(const char* plugin, const Value& scene, double bare) {
  const double primary = observed(plugin, scene, 4000).time / 256;
  std::printf("%-24s %6.1f ns a primary  %6.1f ns a bare ray  ratio %.2f\n", plugin, primary, bare,
              bare / primary);
}

// The rays of one endless path in a scene that needs no scaling.
std::vector<RTCRay> path_rays(const Value& scene) {
  const auto description = paths::read_scene(scene, "");
  const paths::MeshWorld world(std::get<paths::MeshScene>(description.form), description.camera);
  Stream random(stream_key(1, "rays_bench", "", 1), 0);
  Cost cost;
  paths::Vertex v = world.camera(cost);
  std::vector<RTCRay> rays;
  while (rays.size() < (1u << 18)) {
    const paths::Vertex next = world.reflected(v, random, cost);
    RTCRay ray = bare_ray(next.arriving, INFINITY);
    ray.org_x = static_cast<float>(v.position.x);
    ray.org_y = static_cast<float>(v.position.y);
    ray.org_z = static_cast<float>(v.position.z);
    ray.tnear = 0;
    rays.push_back(ray);
    v = next;
  }
  return rays;
}

// A cube of side 1 about the origin: hardly anything to search, so that the rest shows.
std::filesystem::path write_cube() {
  const auto file = std::filesystem::temp_directory_path() / "assay_rays_bench_cube.obj";
  std::ofstream out(file);
  for (int i = 0; i < 8; ++i) {
    out << "v " << (i % 2) - .5 << ' ' << (i / 2 % 2) - .5 << ' ' << (i / 4) - .5 << '\n';
  }
  out << "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
  return file;
}

// Paths inside a mesh whose longest side is 1 and whose middle is the origin: scenes of paths are
// brought to that.
void bench_paths(const std::filesystem::path& mesh) {
  const Value scene = parse_flow("{furnace: {obj: " + mesh.string() +
                                 ", emission: 1, albedo: .8}, camera: {position: [0, 0, 0], "
                                 "direction: [.3, .2, 1]}}");
  const render::TriangleMesh triangles = render::read_obj(mesh);
  const double bare = Bare({triangles}).intersect_time(path_rays(scene));
  for (const char* plugin : {"paths/plain", "paths/roulette"}) {
    const Observed path = observed(plugin, scene, 1000);
    const double time = path.time / path.rays;
    std::printf("%-15s%5zu    %6.1f ns a ray      %6.1f ns a bare ray  ratio %.2f\n", plugin,
                triangles.triangles.size(), time, bare, bare / time);
  }
  std::filesystem::remove(mesh);
}

}  // namespace

int main() {
  const std::filesystem::path sphere = write_sphere({{0.3, 0.2, 0.5}, 0.25});
  const Value scene = parse_flow(
      "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[-.8, -.6, 1], "
      "[.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}, occluders: [{obj: " +
      sphere.string() + "}]}");
  const render::TriangleMesh occluder = render::read_obj(sphere);
  const render::TriangleMesh light =
      render::fan({{-.8, -.6, 1}, {.9, -.6, 1}, {.9, .8, 1}, {-.8, .8, 1}});
  std::printf("isa %s, %zu occluding triangles\n", ray_instruction_set().c_str(),
              occluder.triangles.size());

  const auto to_light = rays_by([](double u, double v) {
    const Vector3 y = {-.8 + 1.7 * u, -.6 + 1.4 * v, 1};
    return bare_ray(normalised(y), length(y) * 0.9998);
  });
  const double shadow = Bare({occluder}).occluded_time(to_light);
  print("luminaire/area", scene, shadow);
  print("luminaire/solid_angle", scene, shadow);

  const Bare both({light, occluder});
  const auto cosine = rays_by(
      [](double u, double v) { return bare_ray(render::cosine_hemisphere(u, v), INFINITY); });
  print("luminaire/cosine", scene, both.intersect_time(cosine));
  const auto uniform = rays_by(
      [](double u, double v) { return bare_ray(render::uniform_hemisphere(u, v), INFINITY); });
  print("luminaire/hemisphere", scene, both.intersect_time(uniform));
  std::filesystem::remove(sphere);
  bench_paths(write_cube());
  bench_paths(write_sphere({{0, 0, 0}, 0.5}));
}
