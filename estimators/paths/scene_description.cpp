#include "paths/scene_description.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "estimators/core/value.h"
#include "luminaire/scene_description.h"
#include "render/polygon.h"

namespace assay::paths {

using render::TriangleMesh;
using render::Vector3;

namespace {

class Reader {
 public:
  explicit Reader(std::string folder) : folder_(std::move(folder)) {}

  SceneDescription scene(const Value& value) {
    require_keys(value, "the scene", {"zones", "furnace", "surfaces", "camera"});
    const Value* form = nullptr;
    for (const char* key : {"zones", "furnace", "surfaces"}) {
      const Value* const found = value.find(key);
      if (!found) continue;
      found->require(!form, "a scene has one of `zones`, `furnace` and `surfaces`");
      form = found;
    }
    value.require(form, "a scene needs one of `zones`, `furnace` and `surfaces`");
    const Value& camera_value = required_key(value, "the scene", "camera");
    require_keys(camera_value, "the camera", {"position", "direction"});
    camera_ = {luminaire::read_vector(required_key(camera_value, "the camera", "position"),
                                      "the camera's position"),
               luminaire::read_unit_vector(required_key(camera_value, "the camera", "direction"),
                                           "the camera's direction")};
    if (value.find("zones")) return {sphere(*form, camera_value), camera_, grey_};
    if (value.find("furnace")) return {furnace(*form, camera_value), camera_, grey_};
    return {surfaces(*form), camera_, grey_};
  }

 private:
  // A number for all colours, or a list of three.
  Rgb colour(const Value& value, const std::string& what) {
    if (value.kind() != Value::Kind::list) return Rgb::grey(at_least_zero(value, what));
    grey_ = false;
    const std::vector<Value>& items = value.items();
    value.require(items.size() == 3, what + " must be a number or a list of three");
    return {at_least_zero(items[0], what), at_least_zero(items[1], what),
            at_least_zero(items[2], what)};
  }

  Surface surface(const Value& value, const std::string& what, bool may_mirror) {
    Surface out;
    out.emission = colour(required_key(value, what, "emission"), what + "'s emission");
    const Value& albedo = required_key(value, what, "albedo");
    out.diffuse = colour(albedo, what + "'s albedo");
    const Value* const mirror = may_mirror ? value.find("mirror") : nullptr;
    if (mirror) out.mirror = colour(*mirror, what + "'s mirror");
    albedo.require(largest(out.albedo()) < 1,
                   what + "'s albedo" + (mirror ? ", `mirror` included," : "") +
                       " must be below 1 in every channel: a path that never loses light never "
                       "ends");
    return out;
  }

  SphereScene sphere(const Value& value, const Value& camera_value) {
    value.require(!value.items().empty(), "zones must be a list of one or more");
    SphereScene out;
    double below = -1;
    for (const Value& item : value.items()) {
      require_keys(item, "a zone", {"top", "emission", "albedo"});
      const Value& top = required_key(item, "a zone", "top");
      const double z = top.number("a zone's top");
      top.require(z > below && z <= 1, "the zones' tops must ascend from -1 to 1");
      below = z;
      out.zones.push_back({z, surface(item, "a zone", false)});
    }
    value.require(below == 1, "the last zone's top must be 1");
    camera_value.require(length(camera_.position) < 1,
                         "the camera must be inside the unit sphere about the origin");
    return out;
  }

  MeshScene furnace(const Value& value, const Value& camera_value) {
    require_keys(value, "the furnace", {"obj", "emission", "albedo", "mirror"});
    const Value& file = required_key(value, "the furnace", "obj");
    MeshScene out;
    out.furnace = true;
    out.mesh = luminaire::read_mesh(file, "the furnace's file", folder_);
    out.surfaces = {surface(value, "the furnace", true)};
    out.surface_of.assign(out.mesh.triangles.size(), 0);
    const std::string why = why_not_closed(out.mesh);
    file.require(why.empty(), "the furnace's mesh is not closed: " + why +
                                  ". Neighbours must share their vertices, and all faces be "
                                  "counter-clockwise from one side");
    camera_value.require(winding_number(out.mesh, camera_.position) != 0,
                         "the camera must be inside the furnace");
    return out;
  }

  MeshScene surfaces(const Value& value) {
    value.require(!value.items().empty(), "surfaces must be a list of one or more");
    MeshScene out;
    for (const Value& item : value.items()) {
      require_keys(item, "a surface", {"polygon", "obj", "emission", "albedo", "mirror"});
      const TriangleMesh mesh = shape(item);
      const auto before = static_cast<std::uint32_t>(out.mesh.vertices.size());
      out.mesh.vertices.insert(out.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      for (const auto& [a, b, c] : mesh.triangles) {
        out.mesh.triangles.push_back({before + a, before + b, before + c});
        out.surface_of.push_back(static_cast<std::uint32_t>(out.surfaces.size()));
      }
      out.surfaces.push_back(surface(item, "a surface", true));
    }
    return out;
  }

  TriangleMesh shape(const Value& value) const {
    const Value* const polygon = value.find("polygon");
    const Value* const file = value.find("obj");
    value.require(!polygon != !file, "a surface needs either `polygon` or `obj`");
    return polygon ? render::fan(luminaire::read_polygon(*polygon, "a surface's polygon"))
                   : luminaire::read_mesh(*file, "a surface's file", folder_);
  }

  std::string folder_;
  Camera camera_;
  bool grey_ = true;
};

// The cube [0, 1]^3 with every face seen counter-clockwise from inside.
SceneDescription furnace() {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  const MeshScene scene{
      mesh, std::vector<std::uint32_t>(12, 0), {{Rgb::grey(1), Rgb::grey(0.5), {}}}, true};
  return {scene, {{0.5, 0.5, 0.5}, render::normalised({0.3, 0.2, -1})}, true};
}

constexpr NamedScene built_in[] = {
    {"furnace", "furnace"},  // A cube of shared vertices, for which there is no text.
    // A tenth of the area shines.
    {"sphere",
     "{zones: [{top: .8, emission: 0, albedo: .8}, {top: 1, emission: 1, albedo: .8}], "
     "camera: {position: [0,0,0], direction: [0,0,-1]}}"},
    // Red, green and blue zones under a cap that shines.
    {"coloured_sphere",
     "{zones: [{top: -.4, emission: 0, albedo: [.8,.2,.1]}, "
     "{top: .2, emission: 0, albedo: [.15,.75,.2]}, {top: .8, emission: 0, albedo: [.1,.25,.85]}, "
     "{top: 1, emission: [1,.9,.6], albedo: [.6,.6,.6]}], "
     "camera: {position: [0,0,0], direction: [0,0,-1]}}"},
    // The proportions of a box with a red and a green wall, a lamp below the ceiling and a block;
    // not Cornell's measured one.
    {"box",
     "{surfaces: [ "
     "{polygon: [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], emission: 0, albedo: [.7,.7,.7]}, "
     "{polygon: [[0,0,1],[0,1,1],[1,1,1],[1,0,1]], emission: 0, albedo: [.7,.7,.7]}, "
     "{polygon: [[0,1,0],[1,1,0],[1,1,1],[0,1,1]], emission: 0, albedo: [.7,.7,.7]}, "
     "{polygon: [[0,0,0],[0,1,0],[0,1,1],[0,0,1]], emission: 0, albedo: [.6,.06,.05]}, "
     "{polygon: [[1,0,0],[1,0,1],[1,1,1],[1,1,0]], emission: 0, albedo: [.1,.45,.1]}, "
     "{polygon: [[0,0,0],[0,0,1],[1,0,1],[1,0,0]], emission: 0, albedo: [.7,.7,.7]}, "
     "{polygon: [[.3,.3,.98],[.3,.7,.98],[.7,.7,.98],[.7,.3,.98]], emission: [12,10,7], albedo: "
     "0}, "
     "{polygon: [[.5,.5,.35],[.8,.4,.35],[.9,.7,.35],[.6,.8,.35]], emission: 0, albedo: "
     "[.7,.7,.7]}, "
     "{polygon: [[.5,.5,0],[.8,.4,0],[.8,.4,.35],[.5,.5,.35]], emission: 0, albedo: [.7,.7,.7]}, "
     "{polygon: [[.8,.4,0],[.9,.7,0],[.9,.7,.35],[.8,.4,.35]], emission: 0, albedo: [.7,.7,.7]}, "
     "{polygon: [[.9,.7,0],[.6,.8,0],[.6,.8,.35],[.9,.7,.35]], emission: 0, albedo: [.7,.7,.7]}, "
     "{polygon: [[.6,.8,0],[.5,.5,0],[.5,.5,.35],[.6,.8,.35]], emission: 0, albedo: [.7,.7,.7]}], "
     "camera: {position: [.5,.02,.5], direction: [-.28,.6,-.48]}}"},
};

}  // namespace

std::string why_not_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& edge : {std::pair{a, b}, {b, c}, {c, a}}) ++count[edge];
  }
  for (const auto& [edge, times] : count) {
    const auto& [from, to] = edge;
    const std::string name = "the edge between its vertices " + std::to_string(from + 1) + " and " +
                             std::to_string(to + 1);
    if (times > 1) return name + " is run through twice the same way";
    if (!count.contains({to, from})) return name + " belongs to one triangle only";
  }
  return "";
}

int winding_number(const TriangleMesh& mesh, const Vector3& point) {
  double angle = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [p, q, r] = mesh.corners(i);
    const Vector3 a = p - point;
    const Vector3 b = q - point;
    const Vector3 c = r - point;
    angle += std::copysign(render::solid_angle(a, b, c), dot(a, cross(b, c)));
  }
  return static_cast<int>(std::lround(angle / (4 * std::numbers::pi)));
}

SceneDescription read_scene(const Value& value, const std::string& folder) {
  const Value scene = scene_of(value, built_in);
  return scene.kind() == Value::Kind::scalar ? furnace() : Reader(folder).scene(scene);
}

}  // namespace assay::paths
