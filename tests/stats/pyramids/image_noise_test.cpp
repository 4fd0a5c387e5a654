#include "stats/pyramids/image_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/philox.h"

namespace assay::stats {
namespace {

using tests::Philox;

PooledNoise pooled(const std::vector<double>& values) {
  PooledNoise noise;
  double squares = 0;
  for (const double x : values) {
    squares += x * x;
    if (std::abs(x) > PooledNoise::least_rare) noise.add_rare(static_cast<float>(x));
  }
  const auto count = static_cast<double>(values.size());
  noise.add_element({.replicates = count, .sum_of_squares = squares * (count - 1) / count});
  return noise;
}

// (x - c)+ and min(x, c)^2 value by value; c at the ends of bins, where nothing is interpolated.
TEST(PooledNoise, HasTheMeansOfTheValuesThatItTook) {
  Philox random(850);
  std::vector<double> values;
  for (int i = 0; i < 2000; ++i) values.push_back(random.normal() * (i % 50 == 0 ? 20 : 1));
  const PooledNoise noise = pooled(values);
  for (const double c : {2.0, 3.0, 4.0, 6.0, 16.0}) {
    for (const std::size_t direction : {upward, downward}) {
      double excess = 0;
      double squares = 0;
      for (const double x : values) {
        const double y = direction == upward ? x : -x;
        excess += std::max(0.0, y - c);
        squares += std::pow(std::min(y, c), 2);
      }
      const PooledNoise::Tail tail = noise.beyond(direction, c);
      EXPECT_NEAR(tail.excess, excess / 2000, 1e-6) << c;
      // The squares of a bin are those of its mean: half an octave has at most 3 % more.
      EXPECT_NEAR(tail.square / (squares / 2000), 1, 0.03) << c;
    }
  }
}

TEST(PooledNoise, IsTheSameInOnePieceOrTwo) {
  Philox random(851);
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(3 * random.normal());
  PooledNoise first = pooled({values.begin(), values.begin() + 500});
  first.merge(pooled({values.begin() + 500, values.end()}));
  const PooledNoise::Tail two = first.beyond(upward, 5);
  const PooledNoise::Tail one = pooled(values).beyond(upward, 5);
  EXPECT_NEAR(two.excess, one.excess, 1e-6);
  EXPECT_NEAR(two.square, one.square, 1e-5);
}

NoisePyramid pyramid_of(const std::array<std::vector<double>, sides_of_pair>& values) {
  NoisePyramid noise({8, 8, 1}, {16, 16});
  for (std::size_t s = 0; s < sides_of_pair; ++s) noise.at(s, 0, 0, 0).merge(pooled(values[s]));
  noise.build();
  return noise;
}

constexpr Rectangle pixel{3, 3, 1, 1};

std::vector<double> normal_values(Philox& random) {
  std::vector<double> values(1024);
  for (double& x : values) x = random.normal();
  return values;
}

// A darker cell that showed none of the bright values which its neighbours on the same side showed.
TEST(NoisePyramid, TakesOffWhatOneSideAloneMayHaveMissed) {
  Philox random(852);
  std::vector<double> rare = normal_values(random);
  for (std::size_t i = 0; i < 40; ++i) rare[i] = 50;
  const CellNoise cell{.effect = -3,
                       .level = {7, 10},
                       .variance = {1.0 / 16, 1.0 / 16},
                       .degrees = 30,
                       .elements = 1,
                       .largest = {{{2, 2}, {2, 2}}}};
  const double alone = -3 / std::sqrt(std::pow(10.0 / 7, 2) / 16 + 1.0 / 16);
  const NoisePyramid clean = pyramid_of({normal_values(random), normal_values(random)});
  EXPECT_NEAR(clean.kept(cell, pixel, 0).t, alone, 0.15);
  // 40 of 1024 values are 48 beyond 2: they carry 1.9 of the mean, less an error of .3.
  const NoisePyramid::Kept one = pyramid_of({rare, normal_values(random)}).kept(cell, pixel, 0);
  EXPECT_NEAR(one.margin, 3 * (40 * 48.0 - std::sqrt(40) * 48) / 1024, 0.05);
  EXPECT_EQ(one.t, 0);
  // The brighter side misses the same.
  const NoisePyramid::Kept both = pyramid_of({rare, rare}).kept(cell, pixel, 0);
  EXPECT_EQ(both.margin, 0);
  EXPECT_NEAR(both.t, alone, 0.15);
  // A brighter cell misses no bright values.
  CellNoise brighter = cell;
  brighter.effect = 3;
  brighter.level = {13, 10};
  EXPECT_NEAR(pyramid_of({rare, normal_values(random)}).kept(brighter, pixel, 0).margin, 0, 0.01);
}

TEST(NoisePyramid, ScalesTheNoiseOfTheDarkerSide) {
  const NoisePyramid none({8, 8, 1}, {16, 16});
  const CellNoise cell{
      .effect = -8, .level = {2, 10}, .variance = {0.04, 0.5}, .degrees = 20, .elements = 4};
  EXPECT_NEAR(none.kept(cell, pixel, 0).t, -8 / std::sqrt(0.04 * 25 + 0.5), 1e-12);
  CellNoise by_elements = cell;
  by_elements.more = 3;
  EXPECT_NEAR(none.kept(by_elements, pixel, 0).t, -8 / std::sqrt(0.54 + 3), 1e-12);
  CellNoise without_light = cell;
  without_light.level = {-2, 6};
  EXPECT_NEAR(none.kept(without_light, pixel, 0).t, -8 / std::sqrt(0.54), 1e-12);
}

TEST(NoisePyramid, ADarkElementHasTheErrorThatItWouldHaveIfLit) {
  const CellNoise element{
      .effect = -9, .level = {1, 10}, .variance = {0.25, 1}, .degrees = 20, .elements = 1};
  // One error beyond either: 9 against 1.5.
  EXPECT_NEAR(variance_of_missing_light(element), 0.25 * (36 - 1), 1e-12);
  CellNoise black = element;
  black.level = {0, 10};
  EXPECT_NEAR(variance_of_missing_light(black), 81, 1e-12);
  CellNoise alike = element;
  alike.level = {9, 10};
  EXPECT_EQ(variance_of_missing_light(alike), 0);
}

// Hall's correction: with skewness g of the numerator, a t that is too low shrinks.
TEST(NoisePyramid, ShrinksSkewedSumsWhereTheyAreTooLow) {
  const NoisePyramid none({8, 8, 1}, {16, 16});
  CellNoise cell{.effect = -4,
                 .level = {-4, 0},
                 .variance = {0.5, 0.5},
                 .degrees = 30,
                 .third = 0.3,
                 .elements = 64};
  const Rectangle whole{0, 0, 8, 8};
  const double shrunk = 4 - 0.3 * 16 / 3 + 0.09 * 64 / 27 - 0.05;
  EXPECT_NEAR(none.kept(cell, whole, 0).t, -shrunk, 1e-12);
  cell.third = -0.3;
  EXPECT_NEAR(none.kept(cell, whole, 0).t, -4, 1e-12);
  cell.third = 1;  // beyond 3 / g: cut off at 1 / g - g / 6
  EXPECT_NEAR(none.kept(cell, whole, 0).t, -(1 - 1.0 / 6), 1e-12);
}

}  // namespace
}  // namespace assay::stats
