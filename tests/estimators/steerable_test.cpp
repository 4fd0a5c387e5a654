#include "steerable/directions.h"
#include "steerable/triangle.h"
#include "tests/estimators/prelude.h"

namespace assay {
namespace {

using namespace assay::steerable;
using render::normalised;
using render::Vector3;

const std::string smooth_sky =
    "sky: {harmonics: [3, .4, -.3, .5, .2, -.35, .3, .25, -.2]}, normal: [.3, -.5, .8]";
const std::string peaked =
    "sky: {peak: {base: .2, height: 20, sharpness: 60, direction: [.3, .2, .8]}}";

TEST(SteerableLobe, OfNineCoefficientsIsOffByThreeThirtySecondsAtMost) {
  double most = 0;
  for (int i = -1000; i <= 1000; ++i) {
    const double c = i / 1000.0;
    most = std::max(most,
                    std::abs(lobe_value({.coefficients = 9, .offset = 0}, c) - std::max(0.0, c)));
  }
  EXPECT_NEAR(most, 3.0 / 32, 1e-15);
}

TEST(SteerableLobe, NeedsAnOffsetOfZeroPointOneFour) {
  EXPECT_NEAR(lobe_minimum({.coefficients = 9, .offset = 0}), -19.0 / 480, 1e-9);
  EXPECT_NEAR(lobe_value({.coefficients = 9, .offset = 0}, -8.0 / 15), -19.0 / 480, 1e-15);
  EXPECT_NEAR(lobe_minimum({.coefficients = 9, .offset = .15}), .00273, 1e-5);
  EXPECT_NEAR(lobe_minimum({.coefficients = 9, .offset = .09}), -.01420, 1e-5);
  EXPECT_NEAR(19.0 / 480 * std::sqrt(4 * pi), .140319, 1e-6);
}

TEST(SteerableLobe, TurnsWithTheNormal) {
  const Vector3 n = normalised({.3, -.5, .8});
  for (const std::size_t count : {1u, 4u, 9u, 25u}) {
    const Lobe lobe{.coefficients = count, .offset = .15};
    const sky::Harmonics a = lobe_coefficients(lobe, n);
    for (const Vector3& w : {n, normalised({1, 2, -3}), Vector3{0, 0, -1}}) {
      const sky::Harmonics y = sky::harmonics(w);
      double sum = 0;
      for (std::size_t i = 0; i < y.size(); ++i) sum += a[i] * y[i];
      EXPECT_NEAR(sum, lobe_value(lobe, dot(n, w)), 1e-14) << count;
    }
  }
}

// On the outline of the square too, to rounding, though it has no inverse.
TEST(LinearTriangle, InvertsItsOwnMap) {
  for (const VertexWeights& w :
       {VertexWeights{1, 2, 5}, VertexWeights{5, 1, 0}, VertexWeights{0, 1, 0},
        VertexWeights{0, 0, 1}, VertexWeights{1, 1, 1}, VertexWeights{1e-9, 1, 1e9}}) {
    for (int i = 0; i <= 16; ++i) {
      for (int j = 0; j <= 16; ++j) {
        const double x = i / 16.0, y = j / 16.0;
        const TrianglePoint p = LinearTriangle{}(w, x, y);
        const bool inside = i % 16 != 0 && j % 16 != 0;
        EXPECT_GE(std::min(p.u, p.v), inside ? 0 : -1e-15);
        EXPECT_LE(p.u + p.v, inside ? 1 : 1 + 1e-15);
        if (!inside) continue;
        const SquarePoint back = square_of(w, p);
        EXPECT_NEAR(back.x, x, 1e-12);
        EXPECT_NEAR(back.y, y, 1e-9);
      }
    }
  }
}

// E[l_i] = (W + w_i) / (4 W).
TEST(LinearTriangle, DeclaresTheMomentsOfItsDensity) {
  EXPECT_DOUBLE_EQ(*channel("steerable/triangle", "{weights: [1, 2, 5]}").mean, 9.0 / 32);
}

std::shared_ptr<const SteeredDirections<>> steered(const std::string& parameters,
                                                   const Lobe& lobe = {}, std::size_t level = 3) {
  Parameters given("steerable/sky", sky::parameters(), parse_flow("{" + parameters + "}"), "");
  const auto setting = sky::read_setting(given);
  return std::make_shared<const SteeredDirections<>>(
      std::make_shared<const SkyTree>(
          setting->radiance(), Preparation{.level = level, .coefficients = lobe.coefficients}),
      lobe, setting->frame());
}

// The midpoint rule on each of the triangles, cut up 16 x 16 in the square behind its uniform
// points.
double mass(const SteeredDirections<>& directions) {
  const auto& tree = directions.tree();
  double sum = 0;
  for (std::size_t t = 0; t < tree.count(); ++t) {
    const auto [a, b, c] = tree.sphere().corners(t);
    const Vector3 normal = cross(b - a, c - a);
    for (int i = 0; i < 16; ++i) {
      for (int j = 0; j < 16; ++j) {
        const double s = (i + .5) / 16;
        const double r = (j + .5) / 16;
        const Vector3 q = a + s * ((b - a) + r * (c - b));
        // du dv = s ds dr, twice the triangle's area; solid angle is area d / |q|^3.
        const double area = s / 256 * length(normal);
        const double solid = area * dot(normalised(normal), a) / std::pow(length(q), 3);
        sum += directions.density(directions.frame().to_local(normalised(q))) * solid;
      }
    }
  }
  return sum;
}

TEST(SteeredDirections, HaveADensityThatIntegratesToOne) {
  EXPECT_NEAR(mass(*steered(smooth_sky)), 1, 3e-3);
  EXPECT_NEAR(mass(*steered(peaked)), 1, 3e-3);
  EXPECT_NEAR(mass(*steered(peaked, {.coefficients = 25})), 1, 3e-3);
  EXPECT_NEAR(mass(*steered(smooth_sky, {.coefficients = 1, .offset = 0}, 1)), 1, 3e-3);
}

TEST(SteeredDirections, DeclareOfADrawWhatTheyAnswerWhenAsked) {
  const auto directions = steered(peaked);
  Stream random({1}, 0);
  for (int i = 0; i < 2000; ++i) {
    const double u = random.uniform();
    const sky::Direction d = directions->draw(u, random.uniform());
    EXPECT_NEAR(directions->density(d.w) / d.density, 1, 1e-9);
    EXPECT_NEAR(length(d.w), 1, 1e-14);
    EXPECT_GT(d.density, 0);
    EXPECT_EQ(d.nodes, 9);  // of 512 triangles
  }
}

// The number that chooses is used again: two thousand equal steps of it give a triangle each its
// share, to one step.
TEST(SteeredDirections, ChooseTrianglesInProportion) {
  const auto directions = steered(smooth_sky, {}, 1);
  const auto& tree = directions->tree();
  std::vector<int> count(tree.count());
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const sky::Direction d = directions->draw((i + .5) / steps, .37);
    ++count[tree.sphere().triangle(directions->frame().to_world(d.w))];
  }
  for (std::size_t t = 0; t < tree.count(); ++t) {
    const double share = tree.node(tree.count() + t, directions->steering()) / directions->total();
    EXPECT_NEAR(count[t], share * steps, 1.5) << t;
  }
}

// Relative standard deviations; 100,000 samples tell two digits.
TEST(SteerableSky, PaysOnAPeakedSkyAndNotOnASmoothOne) {
  const auto relative = [](const std::string& name, const std::string& sky) {
    const Sample s = observe(prepare(name, "{" + sky + "}"), 100000)[0];
    return std::sqrt(s.variance()) / s.mean();
  };
  EXPECT_LT(200 * std::pow(relative("steerable/sky", peaked), 2),
            std::pow(relative("sky/cosine", peaked), 2));
  EXPECT_NEAR(relative("steerable/sky", smooth_sky), .325, .01);
  EXPECT_NEAR(relative("sky/cosine", smooth_sky), .204, .01);
}

}  // namespace
}  // namespace assay
