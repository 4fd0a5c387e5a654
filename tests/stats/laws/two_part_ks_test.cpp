#include "stats/laws/two_part_ks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "stats/tails/tails.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::expect_calibrated;
using tests::expect_caught;
using tests::Experiment;
using tests::Philox;
using tests::sample_of;
using tests::Shape;
using tests::sorted;

// Zero with this probability, uniform otherwise.
std::vector<double> pixels(Philox& random, std::size_t n, double black) {
  return sorted(sample_of(n, [&] {
    const double u = random.uniform();
    return random.uniform() < black ? 0 : u;
  }));
}

TEST(TwoPartKs, SplitsTheValuesAtTheAtom) {
  const std::vector<double> x{0, 0, 0, .2, .9};
  const std::vector<double> y{0, .3, .4};
  const TwoPartTest result = two_part_ks(x, y, 0);
  EXPECT_EQ(result.atoms_x, 3U);
  EXPECT_EQ(result.atoms_y, 1U);
  const std::vector<double> rest_x{.2, .9};
  const std::vector<double> rest_y{.3, .4};
  const TestResult ks = kolmogorov_smirnov(ks_distance(rest_x, rest_y));
  EXPECT_EQ(result.rest.log_p_upper, ks.log_p_upper);
}

TEST(TwoPartKs, TheAtomsOfTwoSamplesAreComparedByFishersExactTest) {
  // scipy: fisher_exact([[8, 2], [1, 5]], "greater")[1] = 0.024475524475524483
  std::vector<double> x(8, 0.0);
  x.insert(x.end(), {.3, .6});
  const std::vector<double> y{0, .1, .2, .4, .7, .8};
  const TwoPartTest result = two_part_ks(x, y, 0);
  EXPECT_EQ(result.atoms_x, 8U);
  EXPECT_EQ(result.atoms_y, 1U);
  EXPECT_NEAR(std::exp(result.atom.log_p_upper), 0.024475524475524483, 1e-12);
  EXPECT_EQ(result.atom.log_p_lower, 0);
}

TEST(TwoPartKs, NothingButAtomsSaysNothingAboutTheRest) {
  const std::vector<double> x(5, 0.0);
  const TwoPartTest two = two_part_ks(x, x, 0);
  EXPECT_EQ(two.log_p, 0);
  EXPECT_EQ(two.rest.log_p_upper, 0);
}

TEST(TwoPartKs, RefusesMalformedSamples) {
  const std::vector<double> unsorted{1, 0};
  const std::vector<double> good{0, 1};
  EXPECT_THROW(two_part_ks(unsorted, good, 0), std::domain_error);
  EXPECT_THROW(two_part_ks({}, good, 0), std::domain_error);
  EXPECT_THROW(two_part_ks(good, good, std::nan("")), std::domain_error);
}

TEST(TwoPartKs, IsAtMostUniform) {
  expect_calibrated({372, 20000, Shape::at_most_uniform}, [](Philox& random) {
    const auto x = pixels(random, 50, .3);
    return two_part_ks(x, pixels(random, 70, .3), 0).log_p;
  });
}

TEST(TwoPartKs, TakingTheSmallerOfTwoPValuesForOneIsCaught) {
  expect_caught({373, 8000, Shape::at_most_uniform}, [](Philox& random) {
    const auto x = pixels(random, 250, .5);
    const TwoPartTest result = two_part_ks(x, pixels(random, 270, .5), 0);
    return std::min(log_p_two_sided(result.atom), result.rest.log_p_upper);
  });
}

// Nine tenths are black in both. The rest is uniform in one and its square in the other, n = 1000
// each, alpha .01. The rest differs by .25 over 100 values, all values by .025 over 1000. Hoeffding
// at 1e-5, R = 500: .11 each.
TEST(TwoPartKs, FindsADifferenceInTheRestThatTheDistanceAloneMisses) {
  Philox random(375);
  int split = 0;
  int alone = 0;
  for (int i = 0; i < 500; ++i) {
    const auto x = pixels(random, 1000, .9);
    auto y = pixels(random, 1000, .9);
    for (double& value : y) value *= value;
    split += two_part_ks(x, y, 0).log_p <= std::log(.01);
    alone += kolmogorov_smirnov(ks_distance(x, y)).log_p_upper <= std::log(.01);
  }
  std::cout << "  found " << split / 500.0 << ", by the distance alone " << alone / 500.0 << "\n";
  EXPECT_GT(split / 500.0 - alone / 500.0, .22);
}

}  // namespace
}  // namespace assay::stats
