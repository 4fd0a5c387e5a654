#include "stats/basics/adaptive_quadrature.h"

#include "tests/stats/point_by_point.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

using Line = AdaptiveQuadrature::Line;

// Jumps along a circle and has a ridge.
double density(double x, double y) {
  return (std::hypot(x - .5, y - .5) < .4 ? 1 : 0) + std::exp(-50 * std::abs(y - x));
}

std::vector<Line> lines() {
  std::vector<Line> all;
  for (int i = 0; i < 20; ++i) all.push_back({.05 * i, {i % 2 == 0 ? 0 : .3, .7 + .015 * i}});
  return all;
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

/// Checks that along() is over() line by line and leaves the rule in the same state.
void expect_the_same(QuadratureLimits limits) {
  AdaptiveQuadrature together(limits);
  AdaptiveQuadrature apart(limits);
  for (int round = 0; round < 3; ++round) {
    const std::vector<Integral> all = together.along(point_by_point(density), lines());
    ASSERT_EQ(all.size(), lines().size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Line line = lines()[i];
      const auto at_x = [&](double y) { return density(line.x, y); };
      const Integral one = apart.over(apart.of(at_x), line.y);
      EXPECT_EQ(bits(all[i].value), bits(one.value)) << i << " of " << limits.evaluations;
      EXPECT_EQ(bits(all[i].error), bits(one.error)) << i << " of " << limits.evaluations;
    }
    EXPECT_EQ(together.exhausted(), apart.exhausted());
    EXPECT_EQ(together.largest(), apart.largest());
  }
}

TEST(AdaptiveQuadrature, LinesSideBySideAreThoseOneByOneBitByBit) {
  for (const double tolerance : {1e-3, 1e-7, 1e-12}) expect_the_same({.tolerance = tolerance});
}

// A density that is rough everywhere would be halved 2^24 times.
TEST(AdaptiveQuadrature, NoMoreIsAskedForThanTheEvaluationsAndALevelOfThem) {
  constexpr std::uint64_t most = 100'000;
  AdaptiveQuadrature rule({.tolerance = 1e-12, .evaluations = most});
  std::uint64_t places = 0;
  std::size_t largest = 0;
  rule.along(
      [&](auto x, auto y, auto values) {
        places += values.size();
        largest = std::max(largest, values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          const double rough = std::sin(1e8 * x[i]) * 1e6 + 1e9 * y[i];
          values[i] = rough - std::floor(rough);
        }
      },
      lines());
  EXPECT_LE(largest, most);
  EXPECT_LE(places, 3 * most);
}

TEST(AdaptiveQuadrature, APoleIsFoundWithinAnErrorThatIsNoMultipleOfItsHeight) {
  for (const double a : {.1, .5, .9}) {
    AdaptiveQuadrature rule({.tolerance = 1e-8});
    const Integral found = rule.over(rule.of([&](double x) { return std::pow(x, -a); }), {0, 1});
    const double integral = 1 / (1 - a);
    EXPECT_NEAR(found.value, integral, found.error) << a;
    EXPECT_LT(found.error, 16 * integral * std::pow(0x1p-23, 1 - a) + 1e-6) << a;
  }
}

// Values known to 1e-3 give an integral that is known no better, however often it is halved.
TEST(AdaptiveQuadrature, ErrorsOfTheValuesThemselvesAreNotHalved) {
  AdaptiveQuadrature rule({.tolerance = 1e-8});
  int calls = 0;
  const auto smooth = [&](const AdaptiveQuadrature::Places& at) {
    ++calls;
    AdaptiveQuadrature::Values values;
    std::ranges::transform(at, values.begin(), [](double x) { return Integral{x, 1e-3}; });
    return values;
  };
  const Integral found = rule.over(smooth, {0, 1});
  EXPECT_NEAR(found.error, 1e-3, 1e-9);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace assay::stats
