// Scenes of paths that may be, and the messages about those that may not.

#include "paths/scene_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>

#include "estimators/core/flow.h"

namespace assay::paths {
namespace {

struct Wrong {
  std::string scene;
  std::string says;
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.scene; }

std::string refusal(const std::string& scene, const std::string& folder = "") {
  try {
    read_scene(parse_flow(scene), folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

const std::string camera = ", camera: {position: [0, 0, 0], direction: [0, 0, -1]}}";

class WrongScenes : public testing::TestWithParam<Wrong> {};

TEST_P(WrongScenes, AreRefusedWithTheReason) {
  EXPECT_THAT(refusal(GetParam().scene), testing::HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Table, WrongScenes,
    testing::Values(
        Wrong{"furnac", "did you mean `furnace`?"},
        Wrong{"{zones: [{top: 1, emission: 1, albedo: .5}]}", "needs the key `camera`"},
        Wrong{"{zone: 1" + camera, "the scene has no key `zone`; did you mean `zones`?"},
        Wrong{"{camera: {position: [0, 0, 0], direction: [0, 0, 1]}}",
              "needs one of `zones`, `furnace` and `surfaces`"},
        Wrong{"{zones: [{top: 1, emission: 1, albedo: .5}], furnace: {obj: x}" + camera,
              "has one of"},
        Wrong{"{zones: []" + camera, "zones must be a list of one or more"},
        Wrong{"{zones: [{top: .5, emission: 1, albedo: .5}]" + camera,
              "the last zone's top must be 1"},
        Wrong{"{zones: [{top: .5, emission: 1, albedo: .5}, {top: .5, emission: 1, albedo: .5}]" +
                  camera,
              "tops must ascend from -1 to 1"},
        Wrong{"{zones: [{top: 1, emission: 1, albedo: 1}]" + camera,
              "a zone's albedo must be below 1 in every channel"},
        Wrong{"{zones: [{top: 1, emission: 1, albedo: [.5, 1.2, .5]}]" + camera, "below 1"},
        Wrong{"{zones: [{top: 1, emission: 1, albedo: -.1}]" + camera,
              "a zone's albedo must be finite and not negative"},
        Wrong{"{zones: [{top: 1, emission: -1, albedo: .1}]" + camera,
              "a zone's emission must be finite and not negative"},
        Wrong{"{zones: [{top: 1, emission: [1, 2], albedo: .1}]" + camera,
              "must be a number or a list of three"},
        Wrong{"{zones: [{top: 1, emission: 1}]" + camera, "needs the key `albedo`"},
        Wrong{"{zones: [{top: 1, emission: 1, albedo: .1, mirror: .1}]" + camera,
              "a zone has no key `mirror`"},
        Wrong{"{zones: [{top: 1, emission: 1, albedo: .5}], camera: {position: [0, 0, 1], "
              "direction: [0, 0, 1]}}",
              "the camera must be inside the unit sphere"},
        Wrong{"{surfaces: [{polygon: [[0,0,0],[1,0,0],[0,1,0]], emission: 0, albedo: .6, mirror: "
              ".4}]" +
                  camera,
              "`mirror` included, must be below 1"},
        Wrong{"{surfaces: [{emission: 0, albedo: .6}]" + camera, "either `polygon` or `obj`"},
        Wrong{"{surfaces: 3" + camera, "surfaces must be a list of one or more"},
        Wrong{"{furnace: {obj: none.obj, emission: 1, albedo: .5}" + camera, "cannot open"}));

// A tetrahedron about the origin; `faces` says which of its four faces are there.
std::string tetrahedron(const std::string& name, const std::string& faces) {
  const auto file = std::filesystem::temp_directory_path() / name;
  std::ofstream(file) << "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\n" << faces;
  return "{furnace: {obj: " + file.string() + ", emission: 1, albedo: .5}, ";
}

constexpr const char* at_origin = "camera: {position: [0, 0, 0], direction: [0, 0, -1]}}";

TEST(Furnaces, AnyClosedMeshWillDo) {
  const std::string scene =
      tetrahedron("assay_paths_closed.obj", "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  EXPECT_EQ(refusal(scene + at_origin), "not refused");
  EXPECT_THAT(refusal(scene + "camera: {position: [2, 0, 0], direction: [0, 0, -1]}}"),
              testing::HasSubstr("the camera must be inside the furnace"));
}

TEST(Furnaces, OpenMeshesAreRefusedWithAnEdge) {
  const std::string scene = tetrahedron("assay_paths_open.obj", "f 1 2 3\nf 1 4 2\nf 1 3 4\n");
  EXPECT_THAT(
      refusal(scene + at_origin),
      testing::HasSubstr("the furnace's mesh is not closed: the edge between its vertices"));
}

TEST(Furnaces, FacesTurnedAboutAreRefused) {
  const std::string scene =
      tetrahedron("assay_paths_turned.obj", "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 3 4\n");
  EXPECT_THAT(refusal(scene + at_origin), testing::HasSubstr("twice the same way"));
}

TEST(BuiltInScenes, AreSound) {
  for (const std::string& name : built_in_scenes()) {
    EXPECT_EQ(refusal(name), "not refused") << name;
  }
}

}  // namespace
}  // namespace assay::paths
