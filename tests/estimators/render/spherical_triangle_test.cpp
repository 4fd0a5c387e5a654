#include "estimators/stream.h"
#include "render/polygon.h"
#include "tests/prelude.h"

namespace assay::render {
namespace {

const std::array<Vector3, 3> plain = {{{.2, -.4, 1}, {1.6, .3, 1.4}, {-.3, 1.2, 1.1}}};
const std::array<Vector3, 3> octant = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
const std::array<Vector3, 3> thin = {{{-1, 0, 1}, {1, 0, 1}, {0, 1e-3, 1}}};
const std::array<Vector3, 3> obtuse = {{{-5, -1, 1}, {5, -1, 1}, {0, .1, 1}}};

class SphericalTriangles : public testing::TestWithParam<std::array<Vector3, 3>> {
 protected:
  SphericalTriangle triangle() const { return {GetParam()[0], GetParam()[1], GetParam()[2]}; }
  SphericalTriangle reversed() const { return {GetParam()[2], GetParam()[1], GetParam()[0]}; }
};

TEST_P(SphericalTriangles, SamplesAreUnitVectorsInside) {
  Stream random({1}, 0);
  for (const SphericalTriangle& t : {triangle(), reversed()}) {
    for (int i = 0; i < 1000; ++i) {
      // Away from the outline, where rounding may fall on either side.
      const double u = 1e-6 + (1 - 2e-6) * random.uniform();
      const double v = 1e-6 + (1 - 2e-6) * random.uniform();
      const Vector3 w = t.sample(u, v);
      EXPECT_NEAR(length(w), 1, 1e-12);
      EXPECT_TRUE(t.contains(w));
      EXPECT_FALSE(t.contains(-w));
    }
  }
}

TEST_P(SphericalTriangles, CornersOfTheSquareAreCornersOfTheTriangle) {
  const SphericalTriangle t = triangle();
  EXPECT_LT(length(t.sample(0.3, 0) - t.b()), 1e-12);
  EXPECT_LT(length(t.sample(0, 1) - t.a()), 1e-6);
  EXPECT_LT(length(t.sample(1, 1) - t.c()), 1e-6);
}

TEST_P(SphericalTriangles, TheFirstNumberIsAFractionOfTheSolidAngle) {
  const SphericalTriangle t = triangle();
  for (const double u : {0.01, 0.25, 0.5, 0.75, 0.99}) {
    const Vector3 c = t.edge_point(u);
    EXPECT_NEAR(solid_angle(t.a(), t.b(), c) / t.solid_angle(), u, 1e-9);
  }
}

TEST_P(SphericalTriangles, TheSecondNumberIsUniformInTheCosine) {
  const SphericalTriangle t = triangle();
  const Vector3 c = t.edge_point(0.4);
  for (const double v : {0.1, 0.5, 0.9}) {
    EXPECT_NEAR(1 - dot(t.arc_point(c, v), t.b()), v * (1 - dot(c, t.b())), 1e-15);
  }
}

TEST_P(SphericalTriangles, CoordinatesInvertTheMap) {
  const SphericalTriangle t = triangle();
  for (const double u : {0.05, 0.3, 0.8}) {
    for (const double v : {0.05, 0.4, 0.95}) {
      const auto [s, r] = t.coordinates(t.sample(u, v));
      EXPECT_NEAR(s, u, 1e-9);
      EXPECT_NEAR(r, v, 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, SphericalTriangles, testing::Values(plain, octant, thin, obtuse));

}  // namespace
}  // namespace assay::render
