#include <array>
#include <stdexcept>

#include "path_tracing/scene.h"

namespace assay::path_tracing {

namespace {

using render::normalised;

/// The sides and the top of a box that stands on the floor y = 0, turned by u about the vertical.
void add_box(std::vector<Thing>& things, const Vector3& corner, const Vector3& u, double height,
             const Material& material) {
  const Vector3 v{-u.z, 0, u.x};
  const Vector3 up{0, height, 0};
  things.push_back({Quad(corner, u, up), material});
  things.push_back({Quad(corner, v, up), material});
  things.push_back({Quad(corner + u, v, up), material});
  things.push_back({Quad(corner + v, u, up), material});
  things.push_back({Quad(corner + up, u, v), material});
}

/// A closed room 2.8 wide, 2 high and 4 deep, with a red and a green wall and a square light under
/// the middle of the ceiling. The camera is inside.
std::vector<Thing> room(double light_side, double radiance) {
  const Rough white{Spectrum::grey(0.72)};
  const Rough red{{0.6, 0.06, 0.05}};
  const Rough green{{0.13, 0.45, 0.09}};
  const double half = light_side / 2;
  return {
      {Quad({-1.4, 0, -1}, {2.8, 0, 0}, {0, 0, 4}), white},  // floor
      {Quad({-1.4, 2, -1}, {2.8, 0, 0}, {0, 0, 4}), white},  // ceiling
      {Quad({-1.4, 0, -1}, {2.8, 0, 0}, {0, 2, 0}), white},  // back
      {Quad({-1.4, 0, 3}, {2.8, 0, 0}, {0, 2, 0}), white},   // behind the camera
      {Quad({-1.4, 0, -1}, {0, 0, 4}, {0, 2, 0}), red},      // left
      {Quad({1.4, 0, -1}, {0, 0, 4}, {0, 2, 0}), green},     // right
      {Quad({-half, 1.98, -half}, {light_side, 0, 0}, {0, 0, light_side}), Black{},
       Spectrum::grey(radiance)},
  };
}

constexpr Camera room_camera{{0, 1, 2.9}, {0, 0.95, 0}, 0.8};

std::shared_ptr<const Scene> mild() {
  std::vector<Thing> things = room(1.2, 4);
  add_box(things, {-0.95, 0, -0.55}, {0.62, 0, -0.2}, 1.2, Rough{Spectrum::grey(0.72)});
  add_box(things, {0.3, 0, 0.2}, {0.55, 0, 0.18}, 0.6, Rough{Spectrum::grey(0.72)});
  return std::make_shared<const Scene>(std::move(things), room_camera, 8);
}

std::shared_ptr<const Scene> glass() {
  std::vector<Thing> things = room(0.25, 80);
  things.push_back({Sphere({0.62, 0.46, 0.45}, 0.45), Glass{1.5}});
  things.push_back({Sphere({-0.6, 0.51, -0.25}, 0.5), Mirror{Spectrum::grey(0.9)}});
  return std::make_shared<const Scene>(std::move(things), room_camera, 10);
}

/// Each plate mirrors the middle of the lights into the camera. Lights of one power: the radiance
/// goes with 1 / radius^2.
std::shared_ptr<const Scene> veach() {
  constexpr Camera camera{{0, 1, 8}, {0, -0.55, 0}, 0.42};
  constexpr std::array exponents{10000.0, 1500.0, 200.0, 30.0};
  constexpr std::array radii{0.03, 0.09, 0.22, 0.5};
  constexpr std::array middles{-1.7, -0.75, 0.25, 1.5};
  constexpr Vector3 lights{0, 0.75, -0.6};
  std::vector<Thing> things;
  const Rough grey{Spectrum::grey(0.3)};
  things.push_back({Quad({-6, -2, 6}, {12, 0, 0}, {0, 0, -9}), grey});  // floor
  things.push_back({Quad({-6, -2, -3}, {12, 0, 0}, {0, 8, 0}), grey});  // back
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    const double k = static_cast<double>(i);
    const Vector3 middle{0, -0.7 - 0.3 * k, -0.9 + 0.75 * k};
    const Vector3 normal =
        normalised(normalised(lights - middle) + normalised(camera.position - middle));
    const Vector3 depth = 0.3 * render::cross({1, 0, 0}, normal);
    const Vector3 width{2.2, 0, 0};
    things.push_back({Quad(middle - width - depth, 2 * width, 2 * depth),
                      Rough{Spectrum::grey(0.05), {0.75, 0.8, 0.85}, exponents[i]}});
  }
  for (std::size_t i = 0; i < radii.size(); ++i) {
    things.push_back({Sphere({middles[i], lights.y, lights.z}, radii[i]), Black{},
                      0.9 / (radii[i] * radii[i]) * Spectrum::grey(1)});
  }
  return std::make_shared<const Scene>(std::move(things), camera, 6);
}

}  // namespace

std::shared_ptr<const Scene> named_scene(const std::string& name) {
  if (name == "mild") return mild();
  if (name == "glass") return glass();
  if (name == "veach") return veach();
  throw std::logic_error("no scene is called " + name);
}

}  // namespace assay::path_tracing
