#include "luminaire/scene_description.h"

#include "estimators/core/value.h"
#include "tests/prelude.h"

namespace assay::luminaire {
namespace {

const std::string receiver = "receiver: {position: [0, 0, 0], normal: [0, 0, 1]}";
const std::string light = "light: {polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: 2}";

SceneDescription read(const std::string& text) { return read_scene(parse_flow(text), ""); }

std::string with_light(const std::string& text) {
  return "{" + receiver + ", light: " + text + "}";
}

TEST(SceneDescription, ReadsASceneInPlace) {
  const SceneDescription scene =
      read("{" + receiver + ", " + light +
           ", occluders: [{polygon: [[0, 0, .5], [1, 0, .5], [0, 1, .5]]}, {disc: {center: [0, 0, "
           ".5], normal: [0, 0, 2], radius: .3}}]}");
  EXPECT_EQ(scene.receiver.normal, (render::Vector3{0, 0, 1}));
  EXPECT_EQ(std::get<render::Polygon>(scene.light.shape).size(), 3u);
  EXPECT_EQ(scene.light.radiance, 2);
  ASSERT_EQ(scene.occluders.size(), 2u);
  EXPECT_EQ(std::get<render::Disc>(scene.occluders[1]).normal, (render::Vector3{0, 0, 1}));
}

TEST(SceneDescription, NormalsAreMadeUnitVectorsWhateverTheirLength) {
  for (const char* normal : {"[0, 0, 1e-200]", "[0, 0, 1e200]", "[0, 0, 7]"}) {
    const SceneDescription scene = read(std::string("{receiver: {position: [0, 0, 0], normal: ") +
                                        normal + "}, " + light + "}");
    EXPECT_EQ(scene.receiver.normal, (render::Vector3{0, 0, 1})) << normal;
  }
}

TEST(SceneDescription, APolygonEmitsTowardsTheReceiverUnlessToldOtherwise) {
  const std::string polygon = "polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: 1";
  EXPECT_TRUE(read(with_light("{" + polygon + "}")).light.clockwise);
  EXPECT_TRUE(read(with_light("{" + polygon + ", normal: [0, 0, -1]}")).light.clockwise);
  EXPECT_FALSE(read(with_light("{" + polygon + ", normal: [0, 0, 1]}")).light.clockwise);
}

TEST(SceneDescription, EveryBuiltInSceneIsThere) {
  for (const char* name : {"triangle", "cornell_triangle", "rectangle"}) {
    EXPECT_NO_THROW(read(name)) << name;
  }
}

TEST(SceneDescription, MistakesAreShownWhereTheyStand) {
  const Value disc = Value::map({{"center", parse_flow("[0, 0, 1]")},
                                 {"normal", parse_flow("[0, 0, 1]")},
                                 {"radius", Value::scalar("wide", {"suite.yaml", 12, 20})}});
  auto scene = parse_flow("{" + receiver + ", " + light + "}").members();
  scene.emplace_back("occluders", Value::list({Value::map({{"disc", disc}})}));
  EXPECT_THAT(thrown<InputError>([&] { read_scene(Value::map(scene), ""); }),
              StartsWith("suite.yaml:12:20: a disc's radius"));
}

TEST(SceneDescription, FilesAreRelativeToTheFolderAndTheirMistakesShownInThem) {
  const Folder place;
  const auto scene = [&](const char* file) {
    return read_scene(parse_flow(with_light("{radiance: 1, obj: " + std::string(file) + "}")),
                      place.path().string());
  };
  place.write("lamp.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 3 2\n");
  EXPECT_EQ(std::get<render::TriangleMesh>(scene("lamp.obj").light.shape).triangles.size(), 1u);
  place.write("broken.obj", "v 0 0 1\nf 1 2 3\n");
  EXPECT_THAT(thrown<InputError>([&] { scene("broken.obj"); }), HasSubstr("broken.obj:2:"));
  EXPECT_THROW(scene("missing.obj"), InputError);
}

}  // namespace
}  // namespace assay::luminaire
