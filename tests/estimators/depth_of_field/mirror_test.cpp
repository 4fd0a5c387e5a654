// A wave in a curved, rough mirror: frequencies against rays, and rays to first order against rays.

#include "depth_of_field/curved_mirror.h"
#include "tests/estimators/prelude.h"

namespace assay::depth_of_field {
namespace {

Channel stated(const std::string& parameters) {
  return channel("depth_of_field/mirror", parameters);
}

// Three in front of a flat mirror and one behind it are four away.
TEST(LensMirror, AFlatOneShowsWhatStandsBehindIt) {
  for (const char* pixel : {"0", ".05"}) {
    const Channel seen = channel("depth_of_field/pixel",
                                 std::string("{scene: sinusoid, pixel: [") + pixel + ", 0]}");
    const Channel mirrored = stated(std::string("{pixel: ") + pixel + "}");
    EXPECT_NEAR(*mirrored.mean, *seen.mean, 1e-14);
    EXPECT_NEAR(*mirrored.variance, *seen.variance, 1e-14);
  }
}

// The board's picture in a mirror of curvature c stands beyond / (1 + 2 c beyond) behind it. It is
// at the focus for c = 1/3.
TEST(LensMirror, OneThatBulgesBringsTheBoardIntoFocus) {
  const Channel sharp = stated("{curvature: .3333333333333333}");
  EXPECT_NEAR(*sharp.mean, 1, 1e-14);
  EXPECT_FALSE(sharp.variance);
  const Channel rough = stated("{curvature: .3333333333333333, roughness: .02}");
  EXPECT_NEAR(*rough.mean, 0.5 + 0.5 * std::exp(-0.5 * 0.9 * 0.9), 1e-14);  // k beyond s = 0.9
}

// The neglected part is of the third order in the ray's distance from the axis and its slope.
TEST(LensMirror, ExactRaysAreLinearInTheLimit) {
  const Lens lens{.radius = 1, .focus = 2};
  for (const double curvature : {-.2, 0., .3}) {
    const CurvedMirror mirror{.distance = .8, .beyond = 1.7, .curvature = curvature};
    ASSERT_TRUE(mirror.returns_all(lens, .5));
    const auto off = [&](double scale) {
      return std::abs(mirror.exact(lens, .6 * scale, -.5 * scale, 0) -
                      mirror.linear(lens, .6 * scale, -.5 * scale, 0));
    };
    if (curvature == 0) {
      EXPECT_LT(off(1), 1e-15);
    } else {
      EXPECT_NEAR(off(.02) / off(.01), 8, .1) << curvature;
    }
  }
}

// A ray that meets the parabola at (x, z): the angle of incidence is that of reflection.
TEST(LensMirror, ExactRaysKeepTheLawOfReflection) {
  const Lens lens{.radius = 1, .focus = 2};
  const CurvedMirror near{.distance = 1, .beyond = 0, .curvature = .3};
  const CurvedMirror far{.distance = 1, .beyond = 1, .curvature = .3};
  for (const double u : {-.7, .1, .9}) {
    const double pixel = .2;
    // Without a way to the board's plane through the vertex, two points of the reflected ray.
    const double slope = far.exact(lens, u, pixel, 0) - near.exact(lens, u, pixel, 0);
    // The point of the hit, by bisection.
    double low = 0, high = 3;
    for (int i = 0; i < 200; ++i) {
      const double z = (low + high) / 2;
      const double x = u + (pixel - u) * z / lens.focus;
      (z < 1 + .15 * x * x ? low : high) = z;
    }
    const double x = u + (pixel - u) * low / lens.focus;
    const double arriving = std::atan((pixel - u) / lens.focus);
    const double normal = std::atan(-.3 * x);  // of the side towards the lens, from -z
    const double leaving = std::atan(slope);
    // The normal bisects the way back and the way on.
    EXPECT_NEAR(leaving + normal, arriving - normal, 1e-12) << u;
  }
}

// A hollow mirror that the ray misses, and a bulging one that sends it on instead of back.
TEST(CurvedMirror, IsRefusedWhereARayMayBeLost) {
  EXPECT_FALSE((CurvedMirror{.distance = 1, .beyond = 1, .curvature = -3})
                   .returns_all({.radius = 1, .focus = 2}, 0));
  EXPECT_FALSE((CurvedMirror{.distance = 1.8, .beyond = 1, .curvature = .2})
                   .returns_all({.radius = .2, .focus = 2}, 2));
  EXPECT_TRUE((CurvedMirror{.distance = 1, .beyond = 1, .curvature = -.1})
                  .returns_all({.radius = .2, .focus = 2}, .5));
}

}  // namespace
}  // namespace assay::depth_of_field
