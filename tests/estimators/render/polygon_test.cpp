#include "render/polygon.h"

#include "tests/prelude.h"

namespace assay::render {
namespace {

constexpr Vector3 up = {0, 0, 1};

// A square of half-width w at height 1 about the axis.
Polygon square(double w) { return {{-w, -w, 1}, {w, -w, 1}, {w, w, 1}, {-w, w, 1}}; }

TEST(Polygon, AreaVectorFollowsTheRightHandRule) {
  EXPECT_EQ(area_vector(square(1)), (Vector3{0, 0, 4}));
  EXPECT_DOUBLE_EQ(area({{1e6, 0, 0}, {1e6 + 1, 0, 0}, {1e6, 1, 0}}), 0.5);
}

TEST(Polygon, ClippingKeepsTheHalfInside) {
  const Polygon half = clipped(square(1), {{1, 0, 0}, 0});
  EXPECT_DOUBLE_EQ(area(half), 2);
  EXPECT_EQ(clipped(square(1), {{0, 0, 1}, 0.5}).size(), 4u);
  EXPECT_TRUE(clipped(square(1), {{0, 0, 1}, 1.5}).empty());
  // Touching the plane with an edge leaves nothing of any extent.
  EXPECT_TRUE(clipped(square(1), {{1, 0, 0}, 1}).empty());
}

TEST(Polygon, AHemisphereOfLightGivesPi) { EXPECT_NEAR(lambert(square(1e9), up), pi, 1e-8); }

TEST(Polygon, AParallelSquareHasItsTextbookFormFactor) {
  // A small patch parallel to a square with a corner on its axis. With X = side / distance, F = X /
  // sqrt(1 + X^2) atan(X / sqrt(1 + X^2)) / pi (Siegel and Howell, configuration factors). Four of
  // them make the square of half-width w.
  for (const double w : {0.1, 1.0, 5.0}) {
    const double ratio = w / std::sqrt(1 + w * w);
    EXPECT_NEAR(lambert(square(w), up), 4 * ratio * std::atan(ratio), 1e-14);
  }
}

TEST(Polygon, LambertDoesNotDependOnOrientationOrExtraVertices) {
  const Polygon one = {{.2, -.4, 1}, {1.6, .3, 1.4}, {-.3, 1.2, 1.1}};
  const Polygon reversed(one.rbegin(), one.rend());
  Polygon split = one;
  split.insert(split.begin() + 1, 0.5 * (one[0] + one[1]));
  EXPECT_DOUBLE_EQ(lambert(one, up), lambert(reversed, up));
  EXPECT_NEAR(lambert(one, up), lambert(split, up), 1e-15);
}

TEST(Polygon, AnOctantHasKnownIntegrals) {
  const Polygon octant = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_DOUBLE_EQ(solid_angle(octant[0], octant[1], octant[2]), pi / 2);
  EXPECT_NEAR(squared_cosine(octant, up), pi / 6, 1e-15);
  EXPECT_NEAR(squared_cosine({octant.rbegin(), octant.rend()}, up), pi / 6, 1e-15);
  EXPECT_NEAR(lambert(octant, up), pi / 4, 1e-15);
}

TEST(Polygon, SolidAnglesOfSmallTrianglesKeepTheirDigits) {
  const double size = 1e-6;
  EXPECT_NEAR(solid_angle({0, 0, 1}, {size, 0, 1}, {0, size, 1}) / (size * size / 2), 1, 1e-11);
}

TEST(Polygon, ConvexityAndPlanarityAreToldApart) {
  EXPECT_TRUE(is_convex(square(1)));
  Polygon dented = square(1);
  dented[2] = {-.5, -.5, 1};
  EXPECT_FALSE(is_convex(dented));
  Polygon star;
  for (int i = 0; i < 5; ++i) {
    star.push_back({std::cos(4 * pi * i / 5), std::sin(4 * pi * i / 5), 1});
  }
  EXPECT_FALSE(is_convex(star));
  EXPECT_TRUE(is_planar(square(1), 1e-6));
  Polygon bent = square(1);
  bent[2].z = 1.1;
  EXPECT_FALSE(is_planar(bent, 1e-6));
}

TEST(Polygon, DistanceToATriangleIsToItsNearestPoint) {
  const Vector3 a = {-1, -1, 2};
  const Vector3 b = {1, -1, 2};
  const Vector3 c = {0, 1, 2};
  EXPECT_DOUBLE_EQ(distance_to_triangle(a, b, c), 2);
  const Vector3 right = {3, 0, 0};
  EXPECT_DOUBLE_EQ(distance_to_triangle(a - right, b - right, c - right), std::sqrt(4 + 1 + 4.0));
  EXPECT_DOUBLE_EQ(distance_to_triangle(b, a, c), 2);
}

}  // namespace
}  // namespace assay::render
