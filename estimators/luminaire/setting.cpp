#include "luminaire/setting.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "estimators/core/mapped.h"

namespace assay::luminaire {

namespace {

using render::Disc;
using render::Frame;
using render::Polygon;
using render::Shape;
using render::TriangleMesh;
using render::Vector3;

// From the scene's coordinates to the receiver's.
class View {
 public:
  explicit View(const Receiver& receiver)
      : origin_(receiver.position), frame_(Frame::about(receiver.normal)) {}

  Vector3 point(const Vector3& p) const { return frame_.to_local(p - origin_); }
  Polygon of(Polygon polygon) const {
    for (Vector3& p : polygon) p = point(p);
    return polygon;
  }
  TriangleMesh shape(const Polygon& polygon) const { return fan(of(polygon)); }
  TriangleMesh shape(TriangleMesh mesh) const {
    for (Vector3& p : mesh.vertices) p = point(p);
    return mesh;
  }
  Disc shape(const Disc& disc) const {
    return {point(disc.centre), frame_.to_local(disc.normal), disc.radius};
  }

 private:
  Vector3 origin_;
  Frame frame_;
};

TriangleMesh light_mesh(const Light& light, const View& view) {
  return std::visit([&](const auto& form) { return view.shape(form); }, light.shape);
}

std::vector<LightTriangle> light_triangles(const TriangleMesh& mesh, bool clockwise) {
  return mapped_indices(mesh.triangles.size(), [&](std::size_t i) -> LightTriangle {
    const auto [a, b, c] = mesh.corners(i);
    const Vector3 area = 0.5 * cross(b - a, c - a);
    const Vector3 normal = normalised(clockwise ? -area : area);
    const double plane_distance = -dot(normal, a);
    return {a, b - a, c - a, normal, length(area), plane_distance, plane_distance > 0};
  });
}

std::optional<std::vector<Polygon>> polygons_of(const std::vector<Occluder>& occluders,
                                                const View& view) {
  std::vector<Polygon> polygons;
  for (const Occluder& occluder : occluders) {
    const Polygon* polygon = std::get_if<Polygon>(&occluder);
    if (!polygon) return {};
    polygons.push_back(view.of(*polygon));
  }
  return polygons;
}

double near_distance(const TriangleMesh& mesh, const Location& where) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.corners(i);
    nearest = std::min(nearest, render::distance_to_triangle(a, b, c));
  }
  if (!(nearest > 0)) throw InputError(where, "the receiver lies on the light");
  return resolution * nearest;
}

// Rays can hit the luminaire, which is shape 0, and the occluders. A planar luminaire never shades
// itself.
std::vector<Shape> shapes_of(const SceneDescription& description, bool with_luminaire) {
  std::vector<Shape> shapes = occluder_shapes(description.occluders, description.receiver);
  if (with_luminaire) {
    TriangleMesh nearer = light_mesh(description.light, View(description.receiver));
    for (Vector3& p : nearer.vertices) p = (1 - resolution) * p;
    shapes.insert(shapes.begin(), std::move(nearer));
  }
  return shapes;
}

}  // namespace

Setting::Setting(const SceneDescription& description, const Location& where)
    : radiance_(description.light.radiance),
      planar_(std::holds_alternative<Polygon>(description.light.shape)),
      triangles_(light_triangles(light_mesh(description.light, View(description.receiver)),
                                 description.light.clockwise)),
      polygonal_occluders_(polygons_of(description.occluders, View(description.receiver))),
      area_(0),
      near_(near_distance(light_mesh(description.light, View(description.receiver)), where)),
      scene_(shapes_of(description, true)),
      blockers_(shapes_of(description, !planar_)) {
  if (planar_) {
    polygon_ = View(description.receiver).of(std::get<Polygon>(description.light.shape));
  }
  for (const LightTriangle& triangle : triangles_) area_ += triangle.area;
}

ParameterInformation scene_parameter() {
  return structure_parameter(
      "scene",
      "a built-in scene (triangle, cornell_triangle, rectangle), or receiver, light and "
      "occluders: `{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {obj: lamp.obj}, "
      "occluders: [{obj: chair.obj}]}`",
      "triangle");
}

Information information(std::string name, std::string summary, std::string description) {
  return {.name = std::move(name),
          .summary = std::move(summary),
          .description = std::move(description),
          .parameters = {scene_parameter()}};
}

SharedSetting read_setting(Parameters& parameters) {
  const SceneDescription scene = read_scene(parameters.structure("scene"), parameters.folder());
  return std::make_shared<const Setting>(scene, parameters.where("scene"));
}

std::vector<Shape> occluder_shapes(const std::vector<Occluder>& occluders,
                                   const Receiver& receiver) {
  return mapped(occluders, [view = View(receiver)](const Occluder& occluder) {
    return std::visit([&](const auto& form) -> Shape { return view.shape(form); }, occluder);
  });
}

}  // namespace assay::luminaire
