// The geometry that paths walk in.

#include "paths/worlds.h"

#include "paths/scene_description.h"
#include "tests/prelude.h"

namespace assay::paths {
namespace {

using render::Vector3;

MeshWorld mesh_world(const char* name) {
  const SceneDescription scene = read_scene(Value::scalar(name), "");
  return {std::get<MeshScene>(scene.form), scene.camera};
}

TEST(ClosedMesh, TheFurnaceIsClosedAndWindsOnceAboutItsInside) {
  const SceneDescription scene = read_scene(Value::scalar("furnace"), "");
  const render::TriangleMesh& mesh = std::get<MeshScene>(scene.form).mesh;
  EXPECT_EQ(why_not_closed(mesh), "");
  EXPECT_EQ(std::abs(winding_number(mesh, {0.5, 0.5, 0.5})), 1);
  EXPECT_EQ(std::abs(winding_number(mesh, {0.01, 0.99, 0.01})), 1);
  EXPECT_EQ(winding_number(mesh, {1.01, 0.5, 0.5}), 0);
}

// Two million rays from hits all over a cube: none slips out, none hits the triangle it starts on.
TEST(MeshWorld, NoRayLeavesAClosedMeshNorHitsWhereItStands) {
  const MeshWorld world = mesh_world("furnace");
  Stream random({1}, 0);
  Cost cost;
  Vertex v = world.camera(cost);
  for (int i = 0; i < 2'000'000; ++i) {
    const Vertex next = world.reflected(v, random, cost);
    ASSERT_NE(next.surface, nullptr) << i;
    ASSERT_NE(next.patch, v.patch) << i;
    v = next;
  }
  EXPECT_EQ(cost.camera_rays, 1u);
  EXPECT_EQ(cost.closest_hit_rays, 2'000'000u);
}

// From an edge, a corner and next to them: the nearest that a hit can be.
TEST(MeshWorld, NoRaySlipsThroughFromEdgesAndCorners) {
  const MeshWorld world = mesh_world("furnace");
  Stream random({1}, 0);
  Cost cost;
  for (std::size_t patch = 0; patch < world.patches(); ++patch) {
    // The inner sides: those that see the furnace.
    const Vertex middle = world.on_patch(patch, 0.5, 0.5);
    if (!world.reflected(middle, 0.5, 0.5).surface) continue;
    for (const double u : {0.0, 1e-9, 1.0}) {
      for (const double v : {0.0, 1e-9, 0.5, 1.0}) {
        const Vertex from = world.on_patch(patch, u, v);
        for (int i = 0; i < 2000; ++i) {
          ASSERT_NE(world.reflected(from, random, cost).surface, nullptr)
              << patch << ' ' << u << ' ' << v;
        }
      }
    }
  }
}

// A sphere by meridians and parallels: the triangles at its poles are slivers.
MeshScene sphere_of_slivers(std::uint32_t count) {
  MeshScene scene{{}, {}, {{Rgb::grey(1), Rgb::grey(0.5), {}}}, true};
  render::TriangleMesh& mesh = scene.mesh;
  mesh.vertices = {{0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t i = 1; i < count; ++i) {
    for (std::uint32_t j = 0; j < count; ++j) {
      mesh.vertices.push_back(
          render::direction_at(std::cos(std::numbers::pi * i / count), double(j) / count));
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 2 + (i - 1) * count + j % count; };
  for (std::uint32_t j = 0; j < count; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({1, at(count - 1, j + 1), at(count - 1, j)});
    for (std::uint32_t i = 1; i + 1 < count; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  scene.surface_of.assign(mesh.triangles.size(), 0);
  return scene;
}

// 80,000 triangles; the smallest inscribed circles are a 10000th of the sphere.
TEST(MeshWorld, NoRayLeavesAFineMeshThroughItsSlivers) {
  const MeshScene scene = sphere_of_slivers(200);
  ASSERT_EQ(why_not_closed(scene.mesh), "");
  const MeshWorld world(scene, {{0, 0, 0}, {0, 0, 1}});
  Stream random({1}, 0);
  Cost cost;
  Vertex v = world.camera(cost);
  for (int i = 0; i < 300'000; ++i) {
    v = world.reflected(v, random, cost);
    ASSERT_NE(v.surface, nullptr) << i;
  }
  // From the slivers themselves, edges and corners: those of the first and the last parallel.
  for (std::size_t patch = 0; patch < world.patches(); patch += 2) {
    for (const std::size_t side : {patch, patch + 1}) {
      const Vertex from = world.on_patch(side, 1, side % 3 == 0 ? 0.5 : 0);
      if (dot(from.normal, from.position) > 0) continue;
      ASSERT_NE(world.reflected(from, random, cost).surface, nullptr) << side;
    }
  }
}

TEST(MeshWorld, MirrorsKeepTheAngle) {
  const MeshWorld world = mesh_world("furnace");
  Cost cost;
  const Vertex v = world.camera(cost);
  const Vertex next = world.mirrored(v, cost);
  ASSERT_NE(next.surface, nullptr);
  EXPECT_NEAR(dot(next.arriving, v.normal), -dot(v.arriving, v.normal), 1e-15);
  EXPECT_NEAR(length(cross(next.arriving, v.normal)), length(cross(v.arriving, v.normal)), 1e-15);
}

TEST(SphereWorld, HitsAreOnTheSphereToDoublePrecisionAlongTheRay) {
  Stream random({1}, 0);
  Vector3 from = {0.3, -0.2, 0.5};
  bool on_surface = false;
  for (int i = 0; i < 100'000; ++i) {
    const Vector3 inward = on_surface ? -from : Vector3{0, 0, 1};
    const double u = random.uniform();
    const double v = random.uniform();
    const Vector3 direction =
        render::Frame::about(inward).to_world(render::cosine_hemisphere(u, v));
    const Vector3 to = exit_of_sphere(from, direction, on_surface);
    ASSERT_NEAR(length(to), 1, 4e-16);
    ASSERT_LT(length(cross(to - from, direction)), 1e-15);
    ASSERT_GE(dot(to - from, direction), 0);
    from = to;
    on_surface = true;
  }
}

TEST(SphereWorld, ZonesAreFoundByHeight) {
  const SceneDescription scene = read_scene(Value::scalar("coloured_sphere"), "");
  const Zones zones(std::get<SphereScene>(scene.form), scene.camera);
  EXPECT_EQ(zones.at(-1), 0u);
  EXPECT_EQ(zones.at(-0.41), 0u);
  EXPECT_EQ(zones.at(-0.39), 1u);
  EXPECT_EQ(zones.at(0.5), 2u);
  EXPECT_EQ(zones.at(1 + 1e-15), 3u);
  double area = 0;
  for (const ZonedScene::Zone& zone : zones.law().zones) area += zone.fraction;
  EXPECT_DOUBLE_EQ(area, 1);
}

}  // namespace
}  // namespace assay::paths
