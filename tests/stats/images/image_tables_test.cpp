// The methods on images against numpy and scipy: tests/tables/make_images.py.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/images/image_equivalence.h"
#include "stats/images/image_sign_flip.h"
#include "stats/images/image_welch.h"
#include "stats/pyramids/image_pyramid.h"
#include "stats/tails/t_to_z.h"
#include "stats/tails/tails.h"
#include "tests/stats/table.h"

namespace assay::stats {
namespace {

using tests::Row;

constexpr ImageExtent extent{13, 9, 2};

struct Owned {
  std::vector<std::vector<double>> images;
  ImageStack<double> view() const {
    ImageStack<double> stack{extent, {}};
    for (const auto& image : images) stack.images.emplace_back(image);
    return stack;
  }
};

// images(k, replicates) of make_images.py, plus a shift.
Owned images_of(int k, int replicates, double shift = 0) {
  Owned stack;
  for (int r = 0; r < replicates; ++r) {
    std::vector<double>& image = stack.images.emplace_back();
    for (int e = 0; e < static_cast<int>(extent.elements()); ++e) {
      const double wave = std::sin(1 + 0.37 * e + 1.7 * r * r + 0.9 * k * e);
      const double tooth = 1 + (7 * r + 3 * e + k) % 5 / 4.0;
      image.push_back(wave * tooth + 0.4 + 0.05 * k + 0.01 * (e % 11) + shift);
    }
  }
  return stack;
}

struct OwnedReference {
  std::vector<double> value;
  std::vector<double> error;
};

OwnedReference reference_values() {
  OwnedReference reference;
  for (std::size_t e = 0; e < extent.elements(); ++e) {
    reference.value.push_back(0.45 + 0.01 * static_cast<double>(e % 11));
    reference.error.push_back(0.02 * static_cast<double>(e % 3));
  }
  return reference;
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

double normal_z(double t, double p) {
  return std::copysign(normal_quantile({Tail::upper, std::log(p / 2)}), t);
}

TEST(ImageTables, EveryElementAgreesWithScipysWelchAndOneSampleT) {
  const Owned a = images_of(1, 16);
  const Owned b = images_of(2, 19);
  const OwnedReference reference = reference_values();
  const ImageReference exact{extent, reference.value};
  std::vector<double> two(extent.elements());
  std::vector<double> one(extent.elements());
  const WelchCounts counts = welch_z(a.view(), b.view(), 0, two);
  EXPECT_EQ(counts.tested, extent.elements());
  welch_z(a.view(), exact, 0, one);
  for (const Row& row : tests::read_table("image_welch")) {
    const auto e = static_cast<std::size_t>(row["element"]);
    SCOPED_TRACE(e);
    EXPECT_NEAR(two[e], normal_z(row["t"], row["p"]), 1e-6);
    EXPECT_NEAR(one[e], normal_z(row["one_t"], row["one_p"]), 1e-6);
    const TestResult welch = welch_element(a.view(), b.view(), e);
    EXPECT_NEAR(welch.statistic, row["t"], 1e-9);
    EXPECT_NEAR(std::exp(log_p_two_sided(welch)) / row["p"], 1, 1e-9);
    const TestResult student = welch_element(a.view(), exact, e);
    EXPECT_NEAR(std::exp(log_p_two_sided(student)) / row["one_p"], 1, 1e-9);
  }
}

const char* grid_of(const ImageFinding& finding) {
  if (finding.statistic == ImageStatistic::energy) return "energy";
  if (finding.statistic == ImageStatistic::alternating) return "alternating";
  const auto [x, y, width, height] = finding.window;
  return x % finding.size == 0 && y % finding.size == 0 ? "aligned" : "shifted";
}

void expect_finding(const ImageFinding& finding, const Row& row) {
  SCOPED_TRACE(row.text("size") + " " + row.text("grid"));
  EXPECT_EQ(finding.size, row["size"]);
  EXPECT_EQ(grid_of(finding), row.text("grid"));
  EXPECT_EQ(static_cast<double>(finding.channel), row["channel"]);
  EXPECT_NEAR(std::exp(finding.log_p) / row["p"], 1, 1e-8);
  EXPECT_NEAR(finding.adjusted_log_p, row["adjusted"], 1e-8);
}

void expect_stack(const ImageFamily& family, const std::string& second) {
  std::size_t group = 1;  // the first is that of single elements, of another table
  for (const Row& row : tests::read_table("image_stack")) {
    if (row.text("second") != second) continue;
    ASSERT_LT(group, family.groups.size());
    expect_finding(family.groups[group++], row);
  }
  EXPECT_EQ(group, family.groups.size());
}

TEST(ImageTables, EveryGroupOfTwoStacksAgreesWithNumpy) {
  expect_stack(image_pyramid(images_of(1, 16, 0.8).view(), images_of(2, 19).view()), "stack");
}

TEST(ImageTables, EveryGroupOfAStackAndAReferenceWithErrorsAgreesWithNumpy) {
  const OwnedReference reference = reference_values();
  expect_stack(image_pyramid(images_of(1, 16, 0.8).view(),
                             ImageReference{extent, reference.value, reference.error}),
               "reference");
}

TEST(ImageTables, EnumeratedFlipsAgreeWithFlippingEveryImage) {
  for (const Row& row : tests::read_table("image_flip")) {
    const Owned a = images_of(1, 16, row["shift"]);
    const SignFlip flip = sign_flip(flip_matrix(a.view(), images_of(2, 16).view()), 0.001);
    EXPECT_NEAR(flip.statistic / row["statistic"], 1, 1e-12);
    EXPECT_NEAR(std::exp(flip.log_p), row["p"], 1e-14);
    EXPECT_EQ(flip.flips, 32767);
    EXPECT_EQ(flip.method, FlipMethod::enumerated);
  }
}

TEST(ImageTables, TheJackknifeAgreesWithLeavingReplicatesOutOneByOne) {
  const Owned a = images_of(1, 16);
  const Owned b = images_of(2, 19);
  const std::vector<Row> rows = tests::read_table("image_equivalence");
  const ImageDistance distance = image_distance(a.view(), b.view());
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
