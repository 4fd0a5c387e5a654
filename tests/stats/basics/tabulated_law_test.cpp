#include "stats/basics/adaptive_quadrature.h"

#include "tests/stats/point_by_point.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

/// The largest distance of a table to its law, at 20001 places.
template <class Law>
double largest_distance(const TabulatedLaw& table, Span range, Law law) {
  double largest = 0;
  for (int k = 0; k <= 20000; ++k) {
    const double x = range.low + range.width() * k / 20000;
    largest = std::max(largest, std::abs(table(x) - law(x)));
  }
  return largest;
}

template <class Law>
void expect_within_its_error(const TabulatedLaw& table, double most, Law law) {
  EXPECT_LE(largest_distance(table, {0, 1}, law), table.error);
  EXPECT_LT(table.error, most);
}

template <class Density>
TabulatedLaw table_of(Density density, Span range, QuadratureLimits limits = {}) {
  AdaptiveQuadrature rule(limits);
  return tabulate(rule.of(density), cut(range, range, {32}), rule);
}

// A lobe of standard deviation 1e-3 in a range of 1: as narrow as a part's 7 nodes can still see.
TEST(TabulatedLaw, FollowsANarrowLobeWithinItsError) {
  constexpr double w = 1e-3;
  const auto table =
      table_of([](double x) { return x / (w * w) * std::exp(-x * x / (2 * w * w)); }, {0, 1});
  expect_within_its_error(table, 5e-6, [](double x) { return -std::expm1(-x * x / (2 * w * w)); });
  EXPECT_NEAR(table.total(), 1, 1e-9);
}

// Each peak lies between two halves of equal mass.
TEST(TabulatedLaw, FollowsPeaksInTheMiddleOfItsPartsWithinItsError) {
  constexpr double wave = 64 * std::numbers::pi;  // a whole wave to a part
  const auto table = table_of([](double x) { return 1 - std::cos(wave * x); }, {0, 1});
  expect_within_its_error(table, 1e-5, [](double x) { return x - std::sin(wave * x) / wave; });
}

// The jump may also lie beyond the outermost node of a part and of its half: 2.5 % of all places.
TEST(TabulatedLaw, FollowsAJumpAnywhereWithinItsError) {
  for (int i = 0; i < 400; ++i) {
    const double jump = std::fmod((i + 1) * std::numbers::phi, 1.0);
    const auto table = table_of([&](double x) { return x < jump ? 1.0 : 11.0; }, {0, 1});
    const double total = jump + 11 * (1 - jump);
    const auto law = [&](double x) { return (x < jump ? x : jump + 11 * (x - jump)) / total; };
    SCOPED_TRACE(jump);
    expect_within_its_error(table, 1e-5, law);
    EXPECT_NEAR(table(jump), law(jump), table.error);
    EXPECT_NEAR(table.total(), total, 1e-7) << "next to a jump two rules may agree by luck";
  }
}

TEST(TabulatedLaw, SaysHowWrongItIsWhenItsEvaluationsRunOut) {
  const auto density = [](double x) { return 1 + std::sin(200 * x); };
  const auto law = [](double x) {
    return (x + (1 - std::cos(200 * x)) / 200) / (1 + (1 - std::cos(200.0)) / 200);
  };
  const auto table = table_of(density, {0, 1}, {.evaluations = 300});
  EXPECT_GT(table.error, 1e-5);
  EXPECT_LE(largest_distance(table, {0, 1}, law), table.error);
}

// A disc's marginal: 2 sqrt(r^2 - (x - 1/2)^2) / (pi r^2), whose density jumps along a curve.
TEST(TabulatedLaw, OfAMarginalAcrossAJumpIsItsClosedForm) {
  constexpr double r = .3;
  const PlaneDensity disc = on_unit_square([](double x, double y) {
    return std::hypot(x - .5, y - .5) < r ? 1 / (std::numbers::pi * r * r) : 0;
  });
  AdaptiveQuadrature rule({.tolerance = 1e-7});
  const auto table = tabulate(marginal_density(disc, rule), cut({0, 1}, {0, 1}, {32}), rule);
  const auto law = [](double x) {
    const double t = std::clamp((x - .5) / r, -1.0, 1.0);
    return .5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
  };
  expect_within_its_error(table, 1e-5, law);
  EXPECT_FALSE(rule.exhausted());
}

TEST(TabulatedLaw, IsZeroBelowAndOneAbove) {
  const auto table = table_of([](double) { return 1.0; }, {2, 3});
  EXPECT_EQ(table(1), 0);
  EXPECT_EQ(table(4), 1);
  EXPECT_NEAR(table(2.25), .25, 1e-12);
}

}  // namespace
}  // namespace assay::stats
