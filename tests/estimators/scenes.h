#pragma once

// Scenes of several tests, as parameters.

#include <string>

namespace assay::tests {

/// The built-in rectangle with a receiver that has part of it below its horizon.
inline const std::string horizon_scene =
    "{receiver: {position: [0, 0, 0], normal: [.9, 0, .3]}, light: {polygon: [[-.8, -.6, 1], "
    "[.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}}";

/// The built-in rectangle, hidden where x > t: half-way up, by a wall over x > t / 2.
inline std::string hidden_beyond(double t) {
  const std::string edge = std::to_string(t / 2);
  return "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[-.8, -.6, 1], "
         "[.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}, occluders: [{polygon: [[" +
         edge + ", -9, .5], [9, -9, .5], [9, 9, .5], [" + edge + ", 9, .5]]}]}";
}

}  // namespace assay::tests

/// The scenes of suites/direct-light.yaml.
namespace assay::direct_light_scenes {

inline const std::string receiver = "receiver: {position: [0, 0, 0], normal: [0, 0, 1]}";
/// Squares in the mirror direction of the viewer, of sides 2 and 0.6 at the distance 2.
inline const std::string large =
    "[[2.1314, -1, 0.6761], [2.1314, 1, 0.6761], [0.738, 1, 2.1108], [0.738, -1, 2.1108]]";
inline const std::string small =
    "[[1.6437, -0.3, 1.1782], [1.6437, 0.3, 1.1782], [1.2257, 0.3, 1.6086], [1.2257, -0.3, "
    "1.6086]]";

inline std::string scene(const std::string& square, const std::string& more = "") {
  return "scene: {" + receiver + ", light: {polygon: " + square + ", radiance: 1}" + more + "}";
}

inline std::string brdf(const std::string& name) {
  const std::string viewer = "theta_i: 0.8, phi_i: 3.1416}}";
  if (name == "smooth") return ", brdf: {ward: {alpha_x: 0.05, alpha_y: 0.05, " + viewer;
  if (name == "rough") return ", brdf: {ward: {alpha_x: 0.5, alpha_y: 0.5, " + viewer;
  return ", brdf: {ashikhmin_shirley: {nu: 1000, nv: 100, " + viewer;
}

/// The parameters of one of the combinations that the tables have.
inline std::string parameters(const std::string& square, const std::string& surface,
                              const std::string& more = "") {
  return "{" + scene(square == "large" ? large : small) + brdf(surface) +
         (more.empty() ? "" : ", " + more) + "}";
}

}  // namespace assay::direct_light_scenes
