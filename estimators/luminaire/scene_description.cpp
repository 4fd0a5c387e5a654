#include "luminaire/scene_description.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/core/value.h"

namespace assay::luminaire {

namespace {

using render::Polygon;
using render::TriangleMesh;
using render::Vector3;

// How far a vertex may lie off a polygon's plane, in diameters: room for coordinates written with
// seven digits. The irradiance of a bent polygon is that of its edges all the same.
constexpr double planarity = 1e-6;

Receiver receiver(const Value& value) {
  require_keys(value, "the receiver", {"position", "normal"});
  return {read_vector(required_key(value, "the receiver", "position"), "the receiver's position"),
          read_unit_vector(required_key(value, "the receiver", "normal"), "the receiver's normal")};
}

// With `normal` the side that it points from emits, else the side that the receiver is on.
Light polygon_light(const Value& value, const Receiver& receiver, double radiance) {
  Polygon vertices =
      read_polygon(required_key(value, "the light", "polygon"), "the light's polygon");
  const Value* const given = value.find("normal");
  const Vector3 emitting =
      given ? read_unit_vector(*given, "the light's normal") : receiver.position - vertices[0];
  const double cosine = dot(emitting, render::normalised(render::area_vector(vertices)));
  // The normal only chooses the side, but one that is far off was meant for something else.
  if (given) {
    given->require(std::abs(cosine) >= 0.99,
                   "the light's normal must be at right angles to its polygon");
  }
  const bool clockwise = dot(render::area_vector(vertices), emitting) < 0;
  return {std::move(vertices), radiance, clockwise};
}

Light light(const Value& value, const Receiver& receiver, const std::string& folder) {
  require_keys(value, "the light", {"polygon", "obj", "normal", "radiance"});
  const Value* const file = value.find("obj");
  const Value* const normal = value.find("normal");
  value.require(!file != !value.find("polygon"), "the light needs either `polygon` or `obj`");
  if (normal) {
    normal->require(!file,
                    "the light's normal belongs to a polygon; an OBJ file's faces emit from the "
                    "side on which they are counter-clockwise");
  }
  const double radiance =
      at_least_zero(required_key(value, "the light", "radiance"), "the light's radiance");
  if (file) return {read_mesh(*file, "the light's file", folder), radiance, false};
  return polygon_light(value, receiver, radiance);
}

render::Disc disc(const Value& value) {
  require_keys(value, "a disc", {"center", "normal", "radius"});
  return {read_vector(required_key(value, "a disc", "center"), "a disc's center"),
          read_unit_vector(required_key(value, "a disc", "normal"), "a disc's normal"),
          at_least_zero(required_key(value, "a disc", "radius"), "a disc's radius")};
}

Occluder occluder(const Value& value, const std::string& folder) {
  require_keys(value, "an occluder", {"polygon", "disc", "obj"});
  value.require(value.members().size() == 1,
                "an occluder needs one of `polygon`, `disc` and `obj`");
  const auto& [key, form] = value.members().front();
  if (key == "polygon") return read_polygon(form, "an occluder's polygon");
  if (key == "disc") return disc(form);
  return read_mesh(form, "an occluder's file", folder);
}

constexpr NamedScene built_in[] = {
    {"triangle",
     "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, "
     "light: {polygon: [[.2, -.4, 1], [1.6, .3, 1.4], [-.3, 1.2, 1.1]], radiance: 1}}"},
    // Cornell University, CS 667, homework 4: `tri-lum-normal`, an equilateral triangle to 4
    // digits.
    {"cornell_triangle",
     "{receiver: {position: [0, 0, 0], normal: [0, 1, 0]}, "
     "light: {polygon: [[0, 5, 1], [-.866, 5, -.5], [.866, 5, -.5]], radiance: 20}}"},
    {"rectangle",
     "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, "
     "light: {polygon: [[-.8, -.6, 1], [-.8, .8, 1], [.9, .8, 1], [.9, -.6, 1]], radiance: 1}}"},
};

}  // namespace

Vector3 read_vector(const Value& value, const std::string& what) {
  const std::vector<Value>& items = value.items();
  value.require(items.size() == 3, what + " must be a list of three numbers");
  return {finite_number(items[0], what), finite_number(items[1], what),
          finite_number(items[2], what)};
}

Vector3 read_unit_vector(const Value& value, const std::string& what) {
  const Vector3 v = read_vector(value, what);
  const double scale = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  value.require(scale != 0, what + " must not be the zero vector");
  return render::normalised(v / scale);
}

Polygon read_polygon(const Value& value, const std::string& what) {
  value.require(value.items().size() >= 3, what + " must be a list of three or more vertices");
  const Polygon vertices = mapped(
      value.items(), [&](const Value& item) { return read_vector(item, "a vertex of " + what); });
  const auto same = std::ranges::adjacent_find(vertices);
  value.require(same == vertices.end() && vertices.front() != vertices.back(),
                what + " has the same vertex twice in a row");
  // Rounding leaves points on a line an area of about 1e-16 squared diameters.
  const double extent = render::diameter(vertices);
  value.require(render::area(vertices) > 1e-12 * extent * extent, what + " has no area");
  value.require(render::is_planar(vertices, planarity), what + " is not planar");
  value.require(render::is_convex(vertices),
                what + " is not convex: split it, or give it as an OBJ file");
  return vertices;
}

TriangleMesh read_mesh(const Value& value, const std::string& what, const std::string& folder) {
  const std::filesystem::path file = std::filesystem::path(folder) / value.string(what);
  try {
    return render::read_obj(file.lexically_normal().string());
  } catch (const InputError& error) {
    // A file that is not there is a mistake of the scene, what stands in it one of the file.
    if (error.where().line != 0) throw;
    const bool is_there = std::filesystem::exists(file);
    throw InputError(value.where(),
                     what + " `" + error.where().file + "`: " + error.message() +
                         (is_there ? "" : "; the path starts at the suite's folder"));
  }
}

std::vector<Occluder> read_occluders(const Value& value, const std::string& folder) {
  value.require(value.kind() == Value::Kind::list, "occluders must be a list");
  return mapped(value.items(), [&](const Value& item) { return occluder(item, folder); });
}

SceneDescription read_scene(const Value& given, const std::string& folder) {
  const Value value = scene_of(given, built_in);
  require_keys(value, "the scene", {"receiver", "light", "occluders"});
  SceneDescription scene;
  scene.receiver = receiver(required_key(value, "the scene", "receiver"));
  scene.light = light(required_key(value, "the scene", "light"), scene.receiver, folder);
  if (const Value* const hiding = value.find("occluders")) {
    scene.occluders = read_occluders(*hiding, folder);
  }
  return scene;
}

}  // namespace assay::luminaire
