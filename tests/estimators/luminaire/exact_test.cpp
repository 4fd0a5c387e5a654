#include "luminaire/exact.h"

#include "estimators/core/value.h"
#include "tests/estimators/prelude.h"
#include "tests/estimators/scenes.h"

namespace assay::luminaire {
namespace {

Setting setting(const std::string& scene) { return {read_scene(parse_flow(scene), ""), {}}; }

std::string scene_of(const std::string& name) {
  const std::string hidden = "hidden_beyond_";
  if (name == "horizon") return tests::horizon_scene;
  if (name.starts_with(hidden)) return tests::hidden_beyond(std::stod(name.substr(hidden.size())));
  return name;
}

void expect_relative(double value, double expected, double tolerance) {
  EXPECT_NEAR(value / expected, 1, tolerance);
}

TEST(ExactIntegrals, AgreeWithQuadrature) {
  const auto rows = tests::table("luminaire.csv");
  ASSERT_EQ(rows.size(), 7u);
  for (const auto& row : rows) {
    SCOPED_TRACE(row[0]);
    const auto exact = exact_integrals(setting(scene_of(row[0])));
    ASSERT_TRUE(exact && exact->squared_geometry);
    expect_relative(exact->irradiance, std::stod(row[1]), 1e-13);
    expect_relative(exact->squared_cosine, std::stod(row[2]), 1e-13);
    expect_relative(exact->solid_angle, std::stod(row[3]), 1e-13);
    expect_relative(*exact->squared_geometry, std::stod(row[4]), 1e-12);
  }
}

TEST(ExactIntegrals, HaveTheGoldenDigits) {
  const auto irradiance = [](const std::string& scene) {
    return *draws::channel("luminaire/area", draws::scene(scene)).mean;
  };
  EXPECT_NEAR(irradiance("triangle"), 0.481046907316, 5e-13);
  EXPECT_NEAR(irradiance("cornell_triangle") * 0.5 / std::numbers::pi, 0.16216329, 5e-9);
  EXPECT_NEAR(irradiance("rectangle"), 1.320523614, 5e-10);
  EXPECT_NEAR(irradiance(tests::horizon_scene), 0.50918, 5e-6);
  EXPECT_NEAR(irradiance(tests::hidden_beyond(0.5)), 1.109821, 5e-7);
  EXPECT_NEAR(irradiance(tests::hidden_beyond(0.05)), 0.693870, 5e-7);
  EXPECT_NEAR(irradiance(tests::hidden_beyond(-0.5)), 0.170871, 5e-7);
  // In a wall, over which the lamp wins.
  const std::string lamp = "{polygon: [[.2, -.4, 1], [1.6, .3, 1.4], [-.3, 1.2, 1.1]]";
  EXPECT_NEAR(irradiance("{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: " + lamp +
                         ", radiance: 1}, occluders: [" + lamp + "}]}"),
              0.481046907316, 1e-12);
  EXPECT_NEAR(unclipped_irradiance(setting(tests::horizon_scene)), 0.44965, 5e-6);
}

TEST(ExactIntegrals, DoNotDependOnWhereTheSceneStands) {
  const auto moved = exact_integrals(
      setting("{receiver: {position: [100, 200, 300], normal: [0, 0, -2]}, light: {polygon: "
              "[[100.2, 200.4, 299], [101.6, 199.7, 298.6], [99.7, 198.8, 298.9]], radiance: 1}}"));
  expect_relative(moved->irradiance, 0.4810469073159319, 1e-12);
}

TEST(ExactIntegrals, SeveralOccludersAreNotCountedTwice) {
  // Two overlapping walls that together hide x > 0.05, and one behind the light.
  const auto exact = exact_integrals(setting(
      "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[-.8, -.6, 1], [.9, "
      "-.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}, occluders: [{polygon: [[.025, -9, .5], "
      "[9, "
      "-9, .5], [9, 9, .5], [.025, 9, .5]]}, {polygon: [[.1, -9, .25], [9, -9, .25], [9, 9, .25], "
      "[.1, 9, .25]]}, {polygon: [[-9, -9, 2], [9, -9, 2], [0, 9, 2]]}]}"));
  expect_relative(exact->irradiance, 0.6938696732270036, 1e-13);
}

TEST(ExactIntegrals, AreNotStatedWhereTheyAreNotKnown) {
  EXPECT_FALSE(exact_integrals(setting(
      "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[0, 0, 1], [1, "
      "0, 1], [0, 1, 1]], radiance: 1}, occluders: [{disc: {center: [0, 0, .5], normal: [0, "
      "0, 1], radius: .1}}]}")));
}

}  // namespace
}  // namespace assay::luminaire
