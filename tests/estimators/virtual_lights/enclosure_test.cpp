#include "tests/prelude.h"
#include "virtual_lights/room.h"

namespace assay::virtual_lights {
namespace {

using render::TriangleMesh;
using render::Vector3;

// Quadrilaterals as two triangles each, no vertex shared.
void add(TriangleMesh& mesh, const std::array<Vector3, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3& corner : corners) mesh.vertices.push_back(corner);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

// Counter-clockwise from inside.
TriangleMesh cube(double low = 0, double high = 1) {
  const double a = low, b = high;
  TriangleMesh mesh;
  add(mesh, {{{a, a, a}, {b, a, a}, {b, b, a}, {a, b, a}}});
  add(mesh, {{{a, a, b}, {a, b, b}, {b, b, b}, {b, a, b}}});
  add(mesh, {{{a, b, a}, {b, b, a}, {b, b, b}, {a, b, b}}});
  add(mesh, {{{a, a, a}, {a, b, a}, {a, b, b}, {a, a, b}}});
  add(mesh, {{{b, a, a}, {b, a, b}, {b, b, b}, {b, b, a}}});
  add(mesh, {{{a, a, a}, {a, a, b}, {b, a, b}, {b, a, a}}});
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  return mesh;
}

constexpr Vector3 middle = {0.5, 0.5, 0.5};

TEST(Enclosure, ACubeHasSixWallsWhicheverWayItIsWritten) {
  for (const bool inwards : {true, false}) {
    const Enclosure room = enclosure(inwards ? cube() : turned(cube()), middle);
    EXPECT_EQ(room.why_open, "");
    EXPECT_EQ(room.why_not_convex, "");
    EXPECT_EQ(room.counter_clockwise, inwards);
    ASSERT_EQ(room.wall_of.size(), 12u);
    for (std::size_t i = 0; i < 12; i += 2) EXPECT_EQ(room.wall_of[i], room.wall_of[i + 1]);
    EXPECT_EQ(std::set(room.wall_of.begin(), room.wall_of.end()).size(), 6u);
  }
}

TEST(Enclosure, WallsAreToldApartInAnyUnit) {
  for (const double unit : {1e-12, 1e-3, 1e3, 1e12}) {
    const Enclosure room = enclosure(cube(0, unit), unit * middle);
    EXPECT_EQ(room.why_not_convex, "") << unit;
    EXPECT_EQ(std::set(room.wall_of.begin(), room.wall_of.end()).size(), 6u) << unit;
    // A floor that is raised by a 1000th of the room in its middle is not flat.
    TriangleMesh bent = cube(0, unit);
    bent.vertices.push_back({0.5 * unit, 0.5 * unit, 0.001 * unit});
    const auto top = static_cast<std::uint32_t>(bent.vertices.size() - 1);
    bent.triangles.erase(bent.triangles.begin(), bent.triangles.begin() + 2);
    for (std::uint32_t i = 0; i < 4; ++i) bent.triangles.push_back({i, (i + 1) % 4, top});
    EXPECT_EQ(enclosure(bent, unit * middle).why_open, "") << unit;
    EXPECT_NE(enclosure(bent, unit * middle).why_not_convex, "") << unit;
  }
}

// Sides of other lengths, turned about (1, 2, 3). Seen from the middle and from next to the floor.
TEST(Enclosure, ABoxIsClosedWhereverItStandsAndHoweverItIsTurned) {
  const Vector3 axis = render::normalised({1, 2, 3});
  for (int i = 0; i < 40; ++i) {
    for (const double angle : {0., 0.37 * i}) {
      const auto placed = [&](const Vector3& v) {  // Rodrigues
        const Vector3 side = {1.1 * v.x, (0.7 + 0.1 * i) * v.y, 0.9 * v.z};
        return Vector3{0.1 * i, 7.3 - 0.7 * i, 0.3} + std::cos(angle) * side +
               std::sin(angle) * cross(axis, side) + (1 - std::cos(angle)) * dot(axis, side) * axis;
      };
      TriangleMesh box = cube();
      for (Vector3& corner : box.vertices) corner = placed(corner);
      for (const double height : {0.5, 1e-4}) {
        const Enclosure room = enclosure(box, placed({0.4, 0.5, height}));
        EXPECT_EQ(room.why_open + room.why_not_convex, "") << i << " " << angle;
        EXPECT_EQ(std::set(room.wall_of.begin(), room.wall_of.end()).size(), 6u);
      }
    }
  }
}

TEST(Enclosure, IsOpenWithoutATriangleOrFromOutside) {
  TriangleMesh mesh = cube();
  mesh.triangles.pop_back();
  EXPECT_THAT(enclosure(mesh, middle).why_open, HasSubstr("belongs to one triangle only"));
  EXPECT_NE(enclosure(mesh, middle).why_not_convex, "");
  EXPECT_THAT(enclosure(cube(), {2, 0.5, 0.5}).why_open, HasSubstr("not inside"));
}

TEST(Enclosure, ABoxInTheRoomLeavesItClosedButNotConvex) {
  TriangleMesh mesh = cube();
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
  const TriangleMesh box = turned(cube(0.1, 0.2));
  mesh.vertices.insert(mesh.vertices.end(), box.vertices.begin(), box.vertices.end());
  for (const auto& [a, b, c] : box.triangles) {
    mesh.triangles.push_back({a + shift, b + shift, c + shift});
  }
  const Enclosure room = enclosure(mesh, middle);
  EXPECT_EQ(room.why_open, "");
  EXPECT_NE(room.why_not_convex, "");
}

}  // namespace
}  // namespace assay::virtual_lights
