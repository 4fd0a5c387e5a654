#include "luminaire/scene_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "estimators/core/flow.h"
#include "luminaire/setting.h"

namespace assay::luminaire {
namespace {

const std::string receiver = "receiver: {position: [0, 0, 0], normal: [0, 0, 1]}";
const std::string light = "light: {polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: 2}";

SceneDescription read(const std::string& text) { return read_scene(parse_flow(text), ""); }

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.message();
  }
  return "";
}

std::string with_light(const std::string& text) {
  return "{" + receiver + ", light: " + text + "}";
}
std::string with_polygon(const std::string& text) {
  return with_light("{radiance: 1, polygon: " + text + "}");
}
std::string with_receiver(const std::string& text) {
  return "{receiver: " + text + ", " + light + "}";
}
std::string with_occluders(const std::string& text) {
  return "{" + receiver + ", " + light + ", occluders: " + text + "}";
}

TEST(SceneDescription, ReadsASceneInPlace) {
  const SceneDescription scene =
      read(with_occluders("[{polygon: [[0, 0, .5], [1, 0, .5], [0, 1, .5]]}, {disc: {center: [0, "
                          "0, .5], normal: [0, 0, "
                          "2], radius: .3}}]"));
  EXPECT_EQ(scene.receiver.normal, (render::Vector3{0, 0, 1}));
  EXPECT_EQ(std::get<render::Polygon>(scene.light.shape).size(), 3u);
  EXPECT_EQ(scene.light.radiance, 2);
  ASSERT_EQ(scene.occluders.size(), 2u);
  EXPECT_EQ(std::get<render::Disc>(scene.occluders[1]).normal, (render::Vector3{0, 0, 1}));
}

TEST(SceneDescription, NormalsAreMadeUnitVectorsWhateverTheirLength) {
  for (const char* normal : {"[0, 0, 1e-200]", "[0, 0, 1e200]", "[0, 0, 7]"}) {
    const SceneDescription scene =
        read(with_receiver("{position: [0, 0, 0], normal: " + std::string(normal) + "}"));
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
  EXPECT_THAT(built_in_scenes(), testing::ElementsAre("triangle", "cornell_triangle", "rectangle"));
  for (const std::string& name : built_in_scenes()) EXPECT_NO_THROW(read(name));
}

TEST(SceneDescription, RefusesUnknownNamesAndKeysWithTheNearest) {
  EXPECT_THAT(refusal("triange"), testing::HasSubstr("did you mean `triangle`?"));
  EXPECT_THAT(refusal("teapot"), testing::HasSubstr("`triangle`, `cornell_triangle`"));
  EXPECT_THAT(refusal("{" + receiver + ", ligth: 1}"), testing::HasSubstr("`light`?"));
  EXPECT_THAT(refusal(with_receiver("{position: [0, 0, 0], norml: [0, 0, 1]}")),
              testing::HasSubstr("`normal`?"));
  EXPECT_THAT(refusal(with_light("{polygn: 1, radiance: 1}")), testing::HasSubstr("`polygon`?"));
  EXPECT_THAT(refusal(with_occluders("[{disk: 1}]")), testing::HasSubstr("`disc`?"));
  EXPECT_THAT(refusal(with_occluders("[{disc: {centre: 1}}]")), testing::HasSubstr("`center`?"));
}

TEST(SceneDescription, RefusesMissingKeys) {
  EXPECT_THAT(refusal("{" + receiver + "}"), testing::HasSubstr("needs the key `light`"));
  EXPECT_THAT(refusal("{" + light + "}"), testing::HasSubstr("needs the key `receiver`"));
  EXPECT_THAT(refusal(with_receiver("{position: [0, 0, 0]}")), testing::HasSubstr("`normal`"));
  EXPECT_THAT(refusal(with_light("{polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]]}")),
              testing::HasSubstr("`radiance`"));
  EXPECT_THAT(refusal(with_light("{radiance: 1}")), testing::HasSubstr("`polygon` or `obj`"));
  EXPECT_THAT(refusal(with_occluders("[{disc: {center: [0, 0, 1], normal: [0, 0, 1]}}]")),
              testing::HasSubstr("`radius`"));
}

TEST(SceneDescription, RefusesWrongShapesOfData) {
  EXPECT_NE(refusal("[1]"), "");
  EXPECT_NE(refusal("null"), "");
  EXPECT_NE(refusal("{receiver: here, " + light + "}"), "");
  EXPECT_NE(refusal(with_receiver("{position: [0, 0], normal: [0, 0, 1]}")), "");
  EXPECT_NE(refusal(with_receiver("{position: 0, normal: [0, 0, 1]}")), "");
  EXPECT_NE(refusal(with_occluders("{polygon: 1}")), "");
  EXPECT_NE(refusal(with_occluders("[wall]")), "");
  EXPECT_THAT(refusal(with_occluders("[{}]")), testing::HasSubstr("needs one of"));
  EXPECT_THAT(refusal(with_light("{obj: a, normal: [0, 0, 1], radiance: 1}")),
              testing::HasSubstr("belongs to a polygon"));
}

TEST(SceneDescription, RefusesNumbersThatAreNotFinite) {
  EXPECT_THAT(refusal(with_receiver("{position: [0, nan, 0], normal: [0, 0, 1]}")),
              testing::HasSubstr("finite"));
  EXPECT_THAT(refusal(with_polygon("[[0, 0, inf], [1, 0, 1], [0, 1, 1]]")),
              testing::HasSubstr("finite"));
  EXPECT_THAT(refusal(with_light("{polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: inf}")),
              testing::HasSubstr("finite"));
}

TEST(SceneDescription, RefusesZeroNormalsAndNegativeSizes) {
  EXPECT_THAT(refusal(with_receiver("{position: [0, 0, 0], normal: [0, 0, 0]}")),
              testing::HasSubstr("zero vector"));
  EXPECT_THAT(refusal(with_light("{polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: -1}")),
              testing::HasSubstr("negative"));
  EXPECT_THAT(
      refusal(with_occluders("[{disc: {center: [0, 0, 1], normal: [0, 0, 1], radius: -1}}]")),
      testing::HasSubstr("negative"));
}

TEST(SceneDescription, RefusesDegeneratePolygons) {
  EXPECT_THAT(refusal(with_polygon("[[0, 0, 1], [1, 0, 1]]")), testing::HasSubstr("three or more"));
  EXPECT_THAT(refusal(with_polygon("[[0, 0, 1], [1, 0, 1], [2, 0, 1]]")),
              testing::HasSubstr("no area"));
  EXPECT_THAT(refusal(with_polygon("[[0, 0, 1], [1, 0, 1], [1, 0, 1], [0, 1, 1]]")),
              testing::HasSubstr("same vertex twice"));
  EXPECT_THAT(refusal(with_polygon("[[0, 0, 1], [1, 0, 1], [1, 1, 1.1], [0, 1, 1]]")),
              testing::HasSubstr("not planar"));
  EXPECT_THAT(refusal(with_polygon("[[0, 0, 1], [1, 0, 1], [.2, .2, 1], [0, 1, 1]]")),
              testing::HasSubstr("not convex"));
}

TEST(SceneDescription, RefusesANormalThatIsNotThePolygons) {
  EXPECT_THAT(
      refusal(with_light("{polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: 1, normal: "
                         "[1, 0, 1]}")),
      testing::HasSubstr("right angles"));
}

TEST(SceneDescription, RefusesAReceiverOnTheLight) {
  const SceneDescription scene =
      read("{receiver: {position: [.1, .1, 1], normal: [0, 0, 1]}, " + light + "}");
  EXPECT_THROW(Setting(scene, {}), InputError);
}

TEST(SceneDescription, MistakesAreShownWhereTheyStand) {
  const Value radius = Value::scalar("wide", {"suite.yaml", 12, 20});
  const Value disc = Value::map({{"center", parse_flow("[0, 0, 1]")},
                                 {"normal", parse_flow("[0, 0, 1]")},
                                 {"radius", radius}});
  const Value scene = Value::map(
      {{"receiver", parse_flow("{position: [0, 0, 0], normal: [0, 0, 1]}")},
       {"light", parse_flow("{polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: 1}")},
       {"occluders", Value::list({Value::map({{"disc", disc}})})}});
  try {
    read_scene(scene, "");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("suite.yaml:12:20: a disc's radius"));
  }
}

TEST(SceneDescription, FilesAreRelativeToTheFolderAndTheirMistakesShownInThem) {
  const std::filesystem::path folder = testing::TempDir();
  const auto scene = [&](const char* file) {
    return read_scene(parse_flow(with_light("{radiance: 1, obj: " + std::string(file) + "}")),
                      folder.string());
  };
  std::ofstream(folder / "lamp.obj") << "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 3 2\n";
  EXPECT_EQ(std::get<render::TriangleMesh>(scene("lamp.obj").light.shape).triangles.size(), 1u);
  std::ofstream(folder / "broken.obj") << "v 0 0 1\nf 1 2 3\n";
  try {
    scene("broken.obj");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().line, 2);
  }
  EXPECT_THROW(scene("missing.obj"), InputError);
  std::filesystem::remove(folder / "lamp.obj");
  std::filesystem::remove(folder / "broken.obj");
}

}  // namespace
}  // namespace assay::luminaire
