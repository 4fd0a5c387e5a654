// Scenes of paths that may be, and the messages about those that may not.

#include "paths/scene_description.h"

#include "estimators/core/value.h"
#include "tests/prelude.h"

namespace assay::paths {
namespace {

std::string refusal(const std::string& scene) {
  return thrown<InputError>([&] { read_scene(parse_flow(scene), ""); });
}

// A tetrahedron about the origin, of which some faces are there.
std::string said_of_faces(const std::string& faces, const char* position = "[0, 0, 0]") {
  const Folder place;
  const std::string file =
      place.write("room.obj", "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\n" + faces);
  return refusal("{furnace: {obj: " + file + ", emission: 1, albedo: .5}, camera: {position: " +
                 position + ", direction: [0, 0, -1]}}");
}

TEST(Furnaces, AreAnyClosedMeshAboutTheCamera) {
  const std::string closed = "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
  EXPECT_EQ(said_of_faces(closed), thrown([] {}));
  EXPECT_THAT(said_of_faces(closed, "[2, 0, 0]"),
              HasSubstr("the camera must be inside the furnace"));
  EXPECT_THAT(said_of_faces("f 1 2 3\nf 1 4 2\nf 1 3 4\n"),
              HasSubstr("the furnace's mesh is not closed: the edge between its vertices"));
  EXPECT_THAT(said_of_faces("f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 3 4\n"),
              HasSubstr("twice the same way"));
}

TEST(BuiltInScenes, AreSound) {
  for (const char* name : {"furnace", "sphere", "coloured_sphere", "box"}) {
    EXPECT_EQ(refusal(name), thrown([] {})) << name;
  }
}

}  // namespace
}  // namespace assay::paths
