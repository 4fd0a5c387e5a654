#include "harness/record/record_of.h"
#include "tests/harness/prelude.h"
#include "tests/harness/questions.h"

namespace assay::harness {
namespace {

constexpr const char* cells_suite = R"(suite: s
estimators:
  ward: {plugin: brdf/ward}
  quadrant: {plugin: mutants/ashikhmin_shirley_single_quadrant}
  cosine: {plugin: luminaire/cosine, scene: triangle}
  disk: {plugin: luminaire/area, scene: triangle}
  normal: {plugin: analytic/exponential_importance}
  narrow: {plugin: mutants/ward_uniform_azimuth, alpha_x: 0.02, alpha_y: 0.03}
tests:
  - {claim: )";

reports::Test tested(const std::string& claim) {
  return run_test(cells_suite + claim + ", secondaries: 20000}\n");
}

double sum(const reports::Map& map) {
  return std::accumulate(map.texels.values.begin(), map.texels.values.end(), 0.0);
}

TEST(CellRecord, HasWhatWasDrawnExpectedAndTheDifferenceInEveryCell) {
  // No cell of this density is halved.
  const reports::Test test = tested("distribution(cosine.direction) == density");
  ASSERT_EQ(test.maps.size(), 3u);
  for (const reports::Map& map : test.maps) {
    EXPECT_EQ(map.width, 32u);
    EXPECT_EQ(map.height, 16u);
    EXPECT_EQ(map.source, "theta 0 to 1.571 from top to bottom, phi 0 to 6.283 from left to right");
    EXPECT_EQ(map.texels.values.size(), 512u);
  }
  // Draws without a point have no cell; five standard errors of how many there are.
  EXPECT_LE(sum(test.maps[0]), 20000);
  EXPECT_NEAR(sum(test.maps[0]), sum(test.maps[1]), 5 * std::sqrt(20000 * 0.25));
  for (std::size_t i = 0; i < 512; ++i) {
    const double expected = test.maps[1].texels.values[i];
    if (!(expected > 0)) continue;
    EXPECT_NEAR(test.maps[2].texels.values[i],
                (test.maps[0].texels.values[i] - expected) / std::sqrt(expected),
                1e-4 * (1 + std::abs(test.maps[2].texels.values[i])));
  }
}

double density_of(const Sampler& ward, double theta, double phi) {
  return ward.density(
      {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
}

// The reference is the midpoint rule over 64 x 400 points, within 1e-3 of the integral here. Counts
// are binomial: 32 columns within 5.5 standard deviations, false alarm 2e-6.
TEST(CellRecord, HasAzimuthsFromLeftToRight) {
  const reports::Test test = tested("distribution(ward.direction) == density");
  ASSERT_GE(test.maps.size(), 3u);
  const auto setup = setup_of("{plugin: brdf/ward}", "direction");
  const Sampler& ward = setup->sampler();
  const std::vector<double>& borders = setup->density_cells().cells.grid().y_borders;
  double least = 1, most = 0;
  for (std::size_t column = 0; column < 32; ++column) {
    double share = 0;
    const double width = borders[column + 1] - borders[column];
    for (int i = 0; i < 64 * 400; ++i) {
      const double theta = (i % 400 + 0.5) / 400 * std::numbers::pi / 2;
      const double phi = borders[column] + (i / 400 + 0.5) / 64 * width;
      share += density_of(ward, theta, phi) * std::sin(theta) * std::numbers::pi / 800 * width / 64;
    }
    least = std::min(least, share / width);
    most = std::max(most, share / width);
    double drawn = 0, expected = 0;
    for (std::size_t row = 0; row < 16; ++row) {
      drawn += test.maps[0].texels.values[row * 32 + column];
      expected += test.maps[1].texels.values[row * 32 + column];
    }
    EXPECT_NEAR(expected, 20000 * share, 20 * share) << column;
    EXPECT_NEAR(drawn, 20000 * share, 5.5 * std::sqrt(20000 * share)) << column;
  }
  EXPECT_GT(most, 5 * least);  // else a map turned round would pass
  // The number of a cell has no moments.
  ASSERT_EQ(test.samples.size(), 1u);
  EXPECT_FALSE(test.samples[0].mean || test.samples[0].variance || test.samples[0].max);
  EXPECT_TRUE(test.samples[0].histogram.counts.empty());
  EXPECT_EQ(test.samples[0].cost.samples, 20000u);
}

// Half vectors of one quadrant are drawn, of all four declared.
TEST(CellRecord, ShowsWhereASamplerIsWrong) {
  const reports::Test test = tested("distribution(quadrant.direction) == density");
  EXPECT_EQ(test.verdict, reports::Verdict::fail);
  ASSERT_EQ(test.maps.size(), 3u);
  const std::vector<float>& z = test.maps[2].texels.values;
  EXPECT_GT(*std::max_element(z.begin(), z.end()), 15);
  EXPECT_LT(*std::min_element(z.begin(), z.end()), -5);
}

TEST(CellRecord, NamesTheShareThatATrianglesCellsAreOf) {
  const reports::Test test = tested("distribution(disk.point) == density");
  ASSERT_EQ(test.maps.size(), 3u) << test.message;
  EXPECT_EQ(test.maps[0].source,
            "u 0 to 1 from top to bottom, v / (1 - u) 0 to 1 from left to right");
}

// The lobe is halved within few cells of the picture, whose sums show nothing of a wrong azimuth.
TEST(CellRecord, ShowsThePartOfAHalvedCellThatIsFarthestOff) {
  const reports::Test test = tested("distribution(narrow.direction) == density");
  ASSERT_EQ(test.maps.size(), 3u) << test.message;
  EXPECT_THAT(test.maps[2].source, testing::HasSubstr("farthest off"));
  double of_sums = 0, shown = 0;
  for (std::size_t i = 0; i < 512; ++i) {
    const double expected = test.maps[1].texels.values[i];
    if (expected < 20) continue;
    of_sums =
        std::max(of_sums, std::abs(test.maps[0].texels.values[i] - expected) / std::sqrt(expected));
    shown = std::max(shown, std::abs(double{test.maps[2].texels.values[i]}));
  }
  EXPECT_LT(of_sums, 5);
  EXPECT_GT(shown, of_sums + 3);
}

// Both samples together give each cell its part, so the expected counts of the first sum to its
// count. Under the null hypothesis the differences have unit variance. The mean square over 256
// cells is 1 within five of its standard deviations, sqrt(2 / 256).
TEST(CellRecord, OfTwoSamplesTheFirstIsHeldAgainstBothTogether) {
  const reports::Test test = tested(
      "distribution(ward.direction) == distribution(ward.direction), test: "
      "chi-square-two-sample");
  ASSERT_EQ(test.maps.size(), 3u) << test.message;
  EXPECT_THAT(test.maps[0].source, testing::HasSubstr("of theta from top to bottom"));
  EXPECT_EQ(test.maps[0].width * test.maps[0].height, 256u);
  EXPECT_NEAR(sum(test.maps[0]), sum(test.maps[1]), 5 * std::sqrt(20000 * 0.25));
  double square = 0;
  for (const float z : test.maps[2].texels.values) square += z * z / 256.0;
  EXPECT_NEAR(square, 1, 5 * std::sqrt(2 / 256.0));
}

TEST(CellRecord, OfAnIntervalOrAMarginalThereIsNone) {
  EXPECT_TRUE(tested("distribution(normal.x) == density").maps.empty());
  EXPECT_TRUE(tested("distribution(ward.direction.theta) == density").maps.empty());
}

}  // namespace
}  // namespace assay::harness
