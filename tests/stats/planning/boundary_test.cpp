#include "stats/planning/boundary.h"

#include "stats/tails/tails.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

std::vector<double> times_of(std::size_t looks, const std::string& growth) {
  if (growth == "close") return {0.2, 0.21, 0.95, 1};
  std::vector<double> times;
  for (std::size_t k = 1; k <= looks; ++k) {
    const double left = static_cast<double>(k) - static_cast<double>(looks);
    times.push_back(growth == "even" ? static_cast<double>(k) / static_cast<double>(looks)
                                     : std::exp2(growth == "root" ? left / 2 : left));
  }
  return times;
}

TEST(Boundary, AgreesWithAWalkOnEvenPoints) {
  for (const tests::Row& row : tests::read_table("boundary")) {
    const WangTsiatis boundary(times_of(static_cast<std::size_t>(row["looks"]), row.text("growth")),
                               row["delta"]);
    EXPECT_NEAR(boundary.constant(row["level"]), row["constant"], 1e-7)
        << row["looks"] << row.text("growth") << row["level"];
  }
}

// Both tails are counted.
TEST(Boundary, AgreesWithTheTablesOfTwoSidedTests) {
  for (const tests::Row& row : tests::read_table("two_sided_boundary")) {
    const std::vector<double> times = times_of(static_cast<std::size_t>(row["looks"]), "even");
    const auto crossed = [&](double constant) {
      std::vector<StoppingLook> looks;
      for (const double time : times) {
        const double z = constant * std::pow(time, row["delta"] - .5);
        looks.push_back({.time = time, .below = -z, .above = z});
      }
      double sum = 0;
      for (const StopProbabilities& stop : stop_probabilities(looks))
        sum += stop.below + stop.above;
      return sum;
    };
    EXPECT_GT(crossed(row["constant"] - .0006), row["level"]) << row["constant"];
    EXPECT_LT(crossed(row["constant"] + .0006), row["level"]) << row["constant"];
  }
}

TEST(Boundary, OneAnalysisIsTheNormalTest) {
  const WangTsiatis boundary(std::vector<double>{7});
  EXPECT_NEAR(boundary.constant(.01), 2.3263478740408408, 1e-12);
  EXPECT_DOUBLE_EQ(boundary.log_crossing(3), normal_tails(3).upper);
}

TEST(Boundary, AConstantAndItsCrossingAreInverse) {
  for (const std::size_t looks : {2U, 7U, 16U}) {
    const WangTsiatis boundary(times_of(looks, "root"));
    for (const double level : {.99, .7, .5, .2, .01, 1e-5, 1e-9, 1e-20}) {
      EXPECT_NEAR(boundary.log_crossing(boundary.constant(level)), std::log(level), 1e-6) << level;
    }
  }
}

// A crossing is at least that of the last analysis and at most the sum.
TEST(Boundary, FarCrossingsStayBetweenTheirBounds) {
  const WangTsiatis boundary(times_of(16, "root"));
  for (const double constant : {8.0, 15.9, 16.1, 30.0, 100.0, 1e5}) {
    double log_sum = -std::numeric_limits<double>::infinity();
    for (const double shape : boundary.shape()) {
      const double part = normal_tails(constant * shape).upper;
      const double larger = std::max(log_sum, part);
      log_sum = larger + std::log(std::exp(log_sum - larger) + std::exp(part - larger));
    }
    EXPECT_GE(boundary.log_crossing(constant), normal_tails(constant).upper * (1 + 1e-9));
    EXPECT_LE(boundary.log_crossing(constant), log_sum * (1 - 1e-9));
  }
}

// A false alarm has probability 1e-6: five deviations of the simulated part.
TEST(Boundary, StopsAsOftenAsSimulatedScores) {
  const std::vector<StoppingLook> looks{
      {.time = 1, .below = -2.5, .from = -.3, .to = .2, .above = 2.2},
      {.time = 1.5, .below = -2.1, .from = -.4, .to = .5, .above = 2.1},
      {.time = 3, .below = -1.5, .from = -.8, .to = .7, .above = 1.9}};
  for (const double drift : {0., .7}) {
    const std::vector<StopProbabilities> expected = stop_probabilities(looks, drift);
    std::vector<StopProbabilities> seen(looks.size());
    Philox random(417);
    constexpr int runs = 200000;
    for (int run = 0; run < runs; ++run) {
      double motion = 0;
      double before = 0;
      for (std::size_t k = 0; k < looks.size(); ++k) {
        const double step = looks[k].time - before;
        before = looks[k].time;
        motion += drift * step + std::sqrt(step) * random.normal();
        const double z = motion / std::sqrt(before);
        double* const stop = z <= looks[k].below                      ? &seen[k].below
                             : z >= looks[k].above                    ? &seen[k].above
                             : looks[k].from <= z && z <= looks[k].to ? &seen[k].between
                                                                      : nullptr;
        if (stop == nullptr) continue;
        *stop += 1.0 / runs;
        break;
      }
    }
    for (std::size_t k = 0; k < looks.size(); ++k) {
      const auto near = [](double rate, double probability) {
        EXPECT_NEAR(rate, probability, 5 * std::sqrt(probability * (1 - probability) / runs));
      };
      near(seen[k].below, expected[k].below);
      near(seen[k].between, expected[k].between);
      near(seen[k].above, expected[k].above);
    }
  }
}

}  // namespace
}  // namespace assay::stats
