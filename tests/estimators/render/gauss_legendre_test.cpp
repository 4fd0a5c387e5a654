#include "render/quadrature.h"
#include "tests/prelude.h"

namespace assay::render {
namespace {

TEST(GaussLegendre, IsExactToTwiceItsNodes) {
  for (int power = 0; power <= 15; ++power) {
    double sum = 0;
    for (const Node& node : gauss_legendre<8>()) sum += node.weight * std::pow(node.place, power);
    EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-14) << power;
  }
  double beyond = 0;
  for (const Node& node : gauss_legendre<8>()) beyond += node.weight * std::pow(node.place, 16);
  EXPECT_GT(std::abs(beyond - 1.0 / 17), 1e-11);
}

const Corners triangle{{{0, 0, 1}, {2, 0, 1}, {0, 1, 1}}};

TEST(TriangleQuadrature, IntegratesAPolynomialAndANarrowLobe) {
  // Integrands 1 and x y over the triangle x / 2 + y <= 1; 0.01 pi of a Gaussian about its inside.
  const auto f = [](const Vector3& p) {
    const double x = (p.x - .5) / .1, y = (p.y - .3) / .1;
    return std::array<double, 3>{1, p.x * p.y, std::exp(-x * x - y * y)};
  };
  TriangleQuadrature<3, decltype(f)> quadrature(f, {.tolerance = 1e-10, .group = {0, 1, 2}});
  for (const Corners& quarter : quartered(triangle)) {
    for (const Corners& part : quartered(quarter)) quadrature.add(part);
  }
  const auto integrals = quadrature.refined();
  EXPECT_NEAR(integrals.value[0], 1, 1e-13);
  EXPECT_NEAR(integrals.value[1], 1.0 / 6, 1e-13);
  // Parts of the lobe lie below y = 0, 3 sigma sqrt 2 away, and left of x = 0.
  const double lobe = .01 * std::numbers::pi * (1 + std::erf(3)) / 2 * (1 + std::erf(5)) / 2;
  EXPECT_NEAR(integrals.value[2], lobe, 2e-7);
  EXPECT_LE(integrals.error[2], 1e-10 * lobe);
}

TEST(TriangleQuadrature, SaysSoWhereItDoesNotConverge) {
  const auto f = [](const Vector3& p) {
    return std::array<double, 1>{p.x * p.x + p.y * p.y < .1 ? 1.0 : 0.0};
  };
  TriangleQuadrature<1, decltype(f)> quadrature(f, {.tolerance = 1e-12, .most = 2000});
  quadrature.add(triangle);
  const auto integrals = quadrature.refined();
  const double exact = .1 * std::numbers::pi / 4;
  EXPECT_GT(integrals.error[0], 1e-12 * exact);
  EXPECT_NEAR(integrals.value[0], exact, integrals.error[0]);
}

}  // namespace
}  // namespace assay::render
