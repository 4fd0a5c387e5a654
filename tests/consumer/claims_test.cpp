// A consumer's tests: 50 true claims about callables, at alpha 0.01 together.
#include <assay/harness/googletest/claims.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace {

using assay::googletest::primary;
using assay::googletest::secondary;

const assay::googletest::DeclaredClaims budget{{.claims = 50, .alpha = 0.01}};

std::string text(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  return digits;
}

TEST(Powers, HaveTheirMeans) {
  for (int i = 1; i <= 25; ++i) {
    const double power = 0.1 * i;
    EXPECT_CLAIM("mean(power) == " + text(1 / (1 + power)),
                 primary("power", [power](assay::Stream& random) {
                   return std::pow(random.uniform(), power);
                 }));
  }
}

TEST(Sums, AreNormalEnough) {
  for (int i = 1; i <= 25; ++i) {
    EXPECT_CLAIM("mean(sum) <= " + text(6.0 * i),
                 secondary("sum", 1, [i](assay::Stream& random, std::span<double> out) {
                   out[0] = 0;
                   for (int k = 0; k < 12; ++k) out[0] += i * random.uniform();
                 }));
  }
}

}  // namespace
