// The methods on images against numpy and scipy: tests/tables/make_images.py.

#include "stats/images/image_equivalence.h"
#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/image_samples.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

constexpr ImageExtent extent{13, 9, 2};

// images(k, replicates) of make_images.py, plus a shift.
OwnedStack images_of(int k, int replicates, double shift = 0) {
  OwnedStack stack{extent, {}};
  for (int r = 0; r < replicates; ++r) {
    std::vector<float>& image = stack.images.emplace_back();
    for (int e = 0; e < static_cast<int>(extent.elements()); ++e) {
      const double wave = std::sin(1 + 0.37 * e + 1.7 * r * r + 0.9 * k * e);
      const double tooth = 1 + (7 * r + 3 * e + k) % 5 / 4.0;
      image.push_back(static_cast<float>(wave * tooth + 0.4 + 0.05 * k + 0.01 * (e % 11) + shift));
    }
  }
  return stack;
}

TEST(ImageTables, TheNormalValueOfStudentsTIsWithinItsStatedError) {
  for (const Row& row : tests::read_table("t_to_z")) {
    const double degrees = row["degrees"];
    const double z = row["z"];
    const double error = std::abs(t_to_z({row["t"], degrees}) - z);
    const bool far = z > 6;
    const double stated = degrees >= 60   ? 1.1e-8
                          : degrees >= 30 ? (far ? 7e-7 : 2e-8)
                          : degrees >= 15 ? (far ? 9e-5 : 9e-7)
                                          : (far ? 8e-3 : 5e-4);
    EXPECT_LE(error, stated) << "nu " << degrees << ", z " << z;
    EXPECT_EQ(t_to_z({-row["t"], degrees}), -t_to_z({row["t"], degrees}));
  }
}

TEST(ImageTables, TheJackknifeAgreesWithLeavingReplicatesOutOneByOne) {
  const auto a = images_of(1, 16);
  const auto b = images_of(2, 19);
  const std::vector<Row> rows = tests::read_table("image_equivalence");
  const ImageDistance distance = image_distance({a.view(), b.view()});
  EXPECT_NEAR(distance.squared_bias, rows[0]["estimate"], 1e-9);
  EXPECT_NEAR(std::sqrt(distance.bias_variance) / rows[0]["standard_error"], 1, 1e-9);
  for (const std::size_t k : {1UL, 2UL}) {
    const double margin = k == 1 ? 0.5 : 1.0;
    const TestResult result = squared_margin_test(distance, margin * margin);
    EXPECT_NEAR(result.statistic, rows[k]["estimate"] / rows[k]["standard_error"], 1e-9);
    EXPECT_NEAR(std::exp(result.log_p_lower) / rows[k]["lower_p"], 1, 1e-9);
  }
}

}  // namespace
}  // namespace assay::stats
