#include "stats/pyramids/image_noise.h"

#include "stats/means/constant_sample.h"
#include "stats/tails/tails.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::stats {
namespace {

using tests::Philox;

constexpr double least_rare = 2;

PooledNoise pooled(const std::vector<double>& values, double unit = 1, bool rare = true) {
  PooledNoise noise;
  PooledNoise::Powers powers{.count = static_cast<double>(values.size())};
  for (const double value : values) {
    const double x = unit * value;
    powers.squares += x * x;
    powers.cubes += x * x * x;
    if (!(std::abs(value) > least_rare)) continue;
    noise.add_large(x, rare);
    if (rare) noise.add_rare_element(std::abs(x), 1);
  }
  noise.add(powers);
  return noise;
}

// Value by value. An octave's values count as its mean. That is too little (Jensen's inequality):
// at its ends by (1 + p)^2 / (1 + 3 p) >= 8/9. Cubes are by (1 + p)^3 / (1 + 7 p) >= .72.
TEST(PooledNoise, HasTheMomentsOfTheValuesCutOff) {
  Philox random(850);
  std::vector<double> values(2000);
  for (std::size_t i = 0; i < 2000; ++i) values[i] = std::abs(random.normal() * (i % 50 ? 1 : 20));
  for (const double unit : {1.0, 1e-9, -1e9}) {
    const PooledNoise noise = pooled(values, unit);
    for (int octave = noise.top(); octave > noise.top() - 4; --octave) {
      for (const bool rare : {false, true}) {
        double squares = 0, cubes = 0;
        for (const double value : values) {
          const double x = std::min(std::abs(unit) * value, std::ldexp(1, octave));
          squares += rare && value <= least_rare ? 0 : x * x / 2000;
          cubes += rare && value <= least_rare ? 0 : std::copysign(x * x * x / 2000, unit);
        }
        const auto [second, third] = rare ? noise.rare_cut_off(octave) : noise.cut_off(octave);
        EXPECT_THAT(second / squares, AllOf(Ge(8.0 / 9), Le(1 + 1e-6))) << octave;
        EXPECT_THAT(third / cubes, AllOf(Ge(0.72), Le(1 + 1e-6))) << octave;
      }
      using enum PooledNoise::Signs;
      EXPECT_EQ(noise.rare_cut_off(octave, unit > 0 ? downward : upward).third, 0);
      EXPECT_EQ(noise.rare_cut_off(octave, unit > 0 ? upward : downward).third,
                noise.rare_cut_off(octave).third);
    }
  }
}

// Octaves fall off the end as larger values come, whether within a piece or by merging.
TEST(PooledNoise, IsTheSameInOnePieceOrTwo) {
  Philox random(851);
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(std::exp(6 * random.normal()));
  PooledNoise first = pooled({values.begin(), values.begin() + 500});
  first.merge(pooled({values.begin() + 500, values.end()}));
  const PooledNoise whole = pooled(values);
  ASSERT_EQ(first.top(), whole.top());
  for (int octave = whole.top(); octave > whole.top() - PooledNoise::octaves; --octave) {
    EXPECT_NEAR(first.cut_off(octave).third / whole.cut_off(octave).third, 1, 1e-5);
    EXPECT_NEAR(first.cut_off(octave).second / whole.cut_off(octave).second, 1, 1e-5);
    EXPECT_EQ(first.rare(octave), whole.rare(octave));
    EXPECT_NEAR(first.rare_cut_off(octave).third / whole.rare_cut_off(octave).third, 1, 1e-5);
  }
}

// One block of 64 elements, of which the first `noisier` have more noise on side 0.
NoisePyramid pyramid_of(const std::array<std::vector<double>, sides_of_pair>& values,
                        std::array<std::size_t, sides_of_pair> replicates = {16, 16},
                        int noisier = 32, bool rare = true) {
  NoisePyramid noise({8, 8, 1}, replicates);
  for (std::size_t s = 0; s < sides_of_pair; ++s) {
    PooledNoise& here = noise.at(s, 0, 0, 0);
    here.merge(pooled(values[s], 1, rare));
    for (int i = 0; i < 64; ++i) here.add_element((s == 0) == (i < noisier));
  }
  noise.build();
  return noise;
}

constexpr Rectangle place{3, 3, 3, 3};
// Its neighbours are calm.
const CellNoise dark{
    .effect = -3, .variance = {.0625, .0625}, .degrees = 30, .weights = 1e9, .concentration = 1};

// A darker cell that showed none of the bright values which its neighbours on the same side showed.
TEST(NoisePyramid, HasTheVarianceOfEqualMeans) {
  // Values of 1 are common.
  const auto with_rare = [](std::size_t count, double size = 50) {
    std::vector<double> values(count, size);
    values.resize(1024, 1);
    return values;
  };
  const std::vector<double> clean = with_rare(0), rare = with_rare(40);
  const auto t_of = [](double growth) { return -3 / std::sqrt(2.0 / 16 + 3 * growth / 16); };
  const double alone = t_of(0);
  const auto t = [](const NoisePyramid& noise) { return noise.kept(dark, place, 0).t(); };
  EXPECT_NEAR(t(pyramid_of({clean, clean})), alone, 1e-9);
  // Sides of one law pool their variance.
  EXPECT_NEAR(t(pyramid_of({clean, clean}, {16, 32})), -3 / std::sqrt(.0625 / 2 + .0625 * 2), 1e-9);
  // The roots of 6.4 and 1.4 are 1.9 standard errors apart: 6 values and 1 may be of one law.
  EXPECT_NEAR(t(pyramid_of({with_rare(6), with_rare(1)})), alone, 1e-9);
  EXPECT_NEAR(t(pyramid_of({with_rare(18), with_rare(1)})), t_of(50 * 17.0 / 18), 1e-9);
  // Sides of different laws: by their rare values, or as 60 of 64 elements are noisier.
  EXPECT_NEAR(t(pyramid_of({rare, clean})), t_of(50), 1e-9);
  for (const int more : {60, 4})
    EXPECT_NEAR(t(pyramid_of({with_rare(8), with_rare(1)}, {16, 16}, more)), t_of(43.75), 1e-9);
  // The brighter has far more, but smaller ones. Dark values of it are no skewness of the darker.
  EXPECT_NEAR(t(pyramid_of({with_rare(4), with_rare(100, 4)})), t_of(50 - 0.64), 1e-9);
  EXPECT_NEAR(t(pyramid_of({with_rare(18), with_rare(1, -50)})), t_of(50), 1e-9);
  // In a wide block the other side's skewness counts by its part in the cell.
  EXPECT_NEAR(pyramid_of({with_rare(18), with_rare(1)}).kept(dark, {3, 3, 1, 1}, 0).t(),
              t_of(50 * (18 - 0.0625 / (2500.0 / 1024 / 16)) / 18), 1e-9);
  // As many in one element tell as little of others as one.
  PooledNoise many;
  many.add({.count = 18, .squares = 18 * 2500.0, .cubes = 18 * 125e3});
  for (int i = 0; i < 18; ++i) many.add_large(50, true);
  many.add_rare_element(50, 18);
  NoisePyramid one = pyramid_of({clean, clean});
  one.at(0, 0, 0, 0).merge(many);
  EXPECT_NEAR(t(one), alone, 1e-9);
  // Nor do octaves that only one side still tells apart.
  EXPECT_NEAR(t(pyramid_of({with_rare(40, 2), with_rare(1, 1e5)})), alone, 1e-9);
  // Values that are common in their elements tell no laws apart, and count with all others.
  EXPECT_NEAR(t(pyramid_of({rare, clean}, {16, 16}, 32, false)), alone, 1e-9);
  EXPECT_NEAR(t(pyramid_of({rare, clean}, {16, 16}, 60, false)),
              t_of((40 * 125000.0 - 40) / (40 * 2500 + 984)), 1e-6);
  // Two rare giants tell their size by themselves, one only with all others.
  NoisePyramid giants = pyramid_of({rare, clean}, {16, 16}, 60, false);
  for (const double growth : {(40 * 125e3 + 1e9) / (40 * 2500 + 1e6 + 984), 1000.0}) {
    giants.at(0, 0, 0, 0).merge(pooled({1000}));
    EXPECT_NEAR(t(giants), t_of(growth), 1e-6);
  }
  // A giant tells no laws apart. A reference is of another law than the pictures.
  EXPECT_NEAR(t(pyramid_of({with_rare(1, 1e5), clean})), alone, 1e-9);
  EXPECT_NEAR(t(pyramid_of({with_rare(1, 1e5), {}}, {16, 0})), t_of(1e5), 1e-8);
  // Differences of pairs count alike in both directions.
  std::vector<double> opposite = rare;
  for (double& x : opposite) x = -x;
  CellNoise bright = dark;
  bright.effect = 3;
  EXPECT_NEAR(pyramid_of({opposite, {}}, {16, 0}).kept(bright, place, 0).t(),
              -t(pyramid_of({rare, {}}, {16, 0})), 1e-9);
  // A cell beside noise of 10 / 3 is no clearer than unseen values of three times that size allow.
  CellNoise quiet = dark;
  quiet.weights = 3 * std::sqrt(8.0) / 10;
  const ImageEffect kept = pyramid_of({clean, {}}, {16, 0}).kept(quiet, place, 0);
  EXPECT_NEAR(log_p_two_sided(student_t_tails(kept.t(), kept.degrees)),
              log_p_constant({0, -10, 10, 16}, {3, std::sqrt(5.0 / 16)}), 1e-9);
  // The brighter side misses the same. A brighter cell misses no bright values.
  EXPECT_NEAR(t(pyramid_of({rare, rare})), alone, 1e-9);
  EXPECT_NEAR(pyramid_of({rare, clean}).kept(bright, place, 0).t(), -alone, 1e-9);
}

TEST(NoisePyramid, TakesACellsOwnThirdCumulant) {
  const NoisePyramid none({8, 8, 1}, {16, 16});
  CellNoise one{.effect = -4, .variance = {.5, .5}, .degrees = 30, .third = .3, .concentration = 1};
  const Rectangle whole{0, 0, 8, 8};
  EXPECT_NEAR(none.kept(one, whole, 0).t(), -4 / std::sqrt(1 + 4 * 0.3), 1e-12);
  one.third = -0.3;
  EXPECT_NEAR(none.kept(one, whole, 0).t(), -4, 1e-12);
}

// Values of 0 and 10 at probability .05: an element lacks .5 if 16 replicates missed all. Values of
// 0 and -10 hide as much.
TEST(NoisePyramid, HidesWhatAnElementMissed) {
  const double size = 10 * (1 - 2 * 0.05);
  const double probability = 0.05 * 0.95 * 100 / (size * size);
  for (const double sign : {1, -1}) {
    std::vector<double> values(1000, -0.5 * sign);
    for (std::size_t i = 0; i < 50; ++i) values[i] = 9.5 * sign;
    PooledNoise noise = pooled(values);
    for (int i = 0; i < 10; ++i) noise.add_element(false);
    EXPECT_NEAR(noise.hidden_squares(16),
                10 * std::pow(size * probability * std::exp(-16 * probability), 2), 1e-5);
  }
}

}  // namespace
}  // namespace assay::stats
