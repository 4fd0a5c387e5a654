#include "stats/images/image_covariance.h"

#include "tests/prelude.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

// x = mean + a u + b v e with u, v normal: C = a a' + diag(b^2).
struct Law {
  std::vector<double> common{.5, -1, 2, 0, 1, .3};
  std::vector<double> own{1, .2, 0, 2, .5, 1};

  OwnedStack draw(Philox& random, std::size_t replicates) const {
    double shared = 0;
    return draw_stack({3, 2, 1}, replicates, [&](std::size_t e) {
      if (e == 0) shared = random.normal();
      return 3 + common[e] * shared + own[e] * random.normal();
    });
  }
  double covariance(std::size_t i, std::size_t j) const {
    return common[i] * common[j] + (i == j ? own[i] * own[i] : 0);
  }
};

// The mean over many stacks is within five of its standard errors of the truth.
TEST(ImageCovariance, IsUnbiased) {
  const Law law;
  double trace = 0;
  double square = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    trace += law.covariance(i, i);
    for (std::size_t j = 0; j < 6; ++j) square += law.covariance(i, j) * law.covariance(i, j);
  }
  Philox random(7201);
  Moments traces;
  Moments squares;
  Moments means;
  Moments errors;
  for (int i = 0; i < 2000; ++i) {
    const ImageCovariance found = image_covariance(law.draw(random, 32).view());
    traces.add(found.trace);
    squares.add(found.squared_trace);
    means.add(found.squared_mean);
    errors.add(found.squared_trace_error * found.squared_trace_error);
  }
  EXPECT_NEAR(traces.mean, trace, 5 * traces.standard_error());
  EXPECT_NEAR(squares.mean, square, 5 * squares.standard_error());
  EXPECT_NEAR(means.mean, 6 * 9, 5 * means.standard_error());
  // The jackknife's variance is on average not too small (Efron & Stein 1981), and here not twice.
  EXPECT_GT(errors.mean, squares.variance() - 5 * errors.standard_error());
  EXPECT_LT(errors.mean, 2 * squares.variance());
}

TEST(ImageCovariance, HasTheDegreesOfItsRank) {
  Philox random(7202);
  double shared = 0;
  const OwnedStack one = draw_stack({8, 8, 1}, 256, [&](std::size_t e) {
    if (e == 0) shared = random.normal();
    return shared;
  });
  EXPECT_NEAR(image_covariance(one.view()).degrees(), 1, .3);
  const OwnedStack all = draw_stack({8, 8, 1}, 256, [&](std::size_t) { return random.normal(); });
  EXPECT_NEAR(image_covariance(all.view()).degrees(), 64, 8);
}

}  // namespace
}  // namespace assay::stats
