// Irradiance from a sky of radiance 1 + cos(theta), by two densities of directions. It is 5 pi / 3.
#include <assay/harness/googletest/claims.h>

#include <cmath>
#include <numbers>

using namespace assay::googletest;

const DeclaredClaims budget{{.claims = 3, .alpha = 0.01}};  // how many claims the binary makes

// One sample f / p. Put your own estimator here; `random` gives its random numbers.
double uniform_direction(assay::Stream& random) {
  const double cosine = random.uniform();  // p = 1 / (2 pi)
  return (1 + cosine) * cosine * 2 * std::numbers::pi;
}

double cosine_direction(assay::Stream& random) {
  const double cosine = std::sqrt(random.uniform());  // p = cosine / pi
  return (1 + cosine) * std::numbers::pi;
}

TEST(Sky, UniformDirectionsAreUnbiased) {
  EXPECT_CLAIM("mean(uniform) == 5.235987755982989", primary("uniform", uniform_direction),
               detect("0.5%"));  // an error of this size must not pass
}

TEST(Sky, DirectionsByTheCosineHaveTheSameMean) {
  EXPECT_CLAIM("mean(cosine) == mean(uniform)", primary("cosine", cosine_direction),
               primary("uniform", uniform_direction), detect("0.5%"));
}

TEST(Sky, DirectionsByTheCosineVaryLess) {
  EXPECT_CLAIM("variance(cosine) < variance(uniform)", primary("cosine", cosine_direction),
               primary("uniform", uniform_direction));
}
