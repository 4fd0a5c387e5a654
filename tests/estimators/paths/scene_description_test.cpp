// Scenes of paths that may be, and the messages about those that may not.

#include "paths/scene_description.h"

#include "estimators/core/flow.h"
#include "tests/prelude.h"

namespace assay::paths {
namespace {

std::string refusal(const std::string& scene) {
  return thrown<InputError>([&] { read_scene(parse_flow(scene), ""); });
}

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
  EXPECT_EQ(refusal(scene + at_origin), thrown([] {}));
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
    EXPECT_EQ(refusal(name), thrown([] {})) << name;
  }
}

}  // namespace
}  // namespace assay::paths
