// Images from sparse samples: unbiased for the interpolant of the lens averages, whose distance to
// them is known.


#include "tests/estimators/depth_of_field/plans.h"
#include "tests/estimators/prelude.h"

namespace assay::depth_of_field {
namespace {

// At x the sinusoid behind the lens has the mean 1/2 + 1/2 j(3) cos(30 x): 2 x 15 of the footprint.
double sinusoid(double x) { return .5 + .5 * disc_response(3) * std::cos(30 * x); }

std::string wave(const std::string& spacing, const char* width = "33") {
  return std::string("{scene: sinusoid, width: ") + width +
         ", height: 1, size: .4, samples: 4, spacing: " + spacing + "}";
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double x : values) most = std::max(most, std::abs(x));
  return most;
}

// The densities are those that the prediction chooses for the suites, and every eighth pixel.
TEST(Reconstruction, ItsBiasIsThatOfAnIndependentInterpolation) {
  for (const auto& row : tests::table("reconstruction.csv")) {
    const std::string parameters = "{scene: sinusoid, height: 1, width: " + row[0] +
                                   ", size: " + row[1] + ", spacing: " + row[2] + "}";
    const auto plan = reconstruction_plan(parameters);
    const auto channels = prepare("depth_of_field/reconstruction", parameters).setup->channels();
    EXPECT_NEAR(*channels.back().mean, std::stod(row[5]), 1e-10);
    const std::vector<double> bias = plan.bias();
    double off = 0, all = 0;
    for (std::size_t i = 0; i < bias.size(); ++i) {
      off += bias[i] * bias[i];
      all += plan.exact[i].mean * plan.exact[i].mean;
    }
    const std::size_t worst = std::stoul(row[4]);
    EXPECT_NEAR(std::sqrt(off / all), std::stod(row[3]), 1e-10);
    EXPECT_NEAR(plan.exact[worst].mean, std::stod(row[5]), 1e-10);
    EXPECT_NEAR(plan.exact[worst].mean + bias[worst], std::stod(row[6]), 1e-10);
    EXPECT_NEAR(largest(bias), std::abs(bias[worst]), 1e-12);
  }
}

TEST(Reconstruction, WithASampleAPixelHasNoBias) {
  EXPECT_EQ(largest(reconstruction_plan(wave("1")).bias()), 0);
}

// Half way between samples d apart linear interpolation is off by -f'' d^2 / 8. For a wave the part
// of that is between 1 - z^2 / 12 and 1, z = 15 d.
TEST(Reconstruction, ItsBiasGrowsAsTheSquareOfTheSpacing) {
  for (const std::size_t spacing : {2u, 4u, 8u}) {
    const auto plan = reconstruction_plan(wave(std::to_string(spacing)));
    const double z = 15 * plan.grid.pitch() * static_cast<double>(spacing);
    const double square = -(sinusoid(plan.grid.pixel(spacing / 2).x) - .5) * z * z / 2;
    const double part = plan.bias()[spacing / 2] / square;
    EXPECT_LT(part, 1) << spacing;
    EXPECT_GT(part, 1 - z * z / 12) << spacing;
  }
}

// The highest frequency of the image is that of the wave, 30. Two samples a period are pi / 30
// apart: 8.6 pixels of 0.4 / 33, or 3.5 of 0.03.
TEST(Reconstruction, SamplesAreAsDenseAsThePredictedDetailAsks) {
  EXPECT_EQ(reconstruction_plan(wave("0")).samples.size(), 5u);
  const auto coarse =
      reconstruction_plan("{scene: sinusoid, width: 32, height: 1, size: .96, samples: 4}");
  EXPECT_EQ(coarse.samples.size(), 16u);
}

TEST(Reconstruction, CountsGoWithThePredictedVarianceOfTheSamples) {
  const auto plan = reconstruction_plan("{scene: edge, width: 24, height: 1, size: 2, samples: 9}");
  const auto found = predict(*plan.setting, plan.grid, wave_rules());
  std::vector<double> variances;
  for (const ImageSample& s : plan.samples) variances.push_back(found.variance[s.x]);
  EXPECT_EQ(plan.counts, lens_counts(variances, {9}));
  EXPECT_NE(plan.counts.front(), *std::ranges::max_element(plan.counts));
  EXPECT_EQ(plan.overhead.camera_rays, 24u + 10);
}

// False alarm 1e-6 each of 33.
TEST(Reconstruction, PixelsAreUnbiasedForTheInterpolant) {
  const auto plan = reconstruction_plan(wave("8"));
  const std::vector<double> bias = plan.bias();
  const auto image = prepare("depth_of_field/reconstruction", wave("8"));
  const auto samples = observe(image, 20000);
  const auto channels = image.setup->channels();
  for (std::size_t i = 0; i < 33; ++i) {
    EXPECT_NEAR(*channels[i].mean, sinusoid(plan.grid.pixel(i).x), 1e-12);
    EXPECT_THAT(samples[i], HasMean(*channels[i].mean + bias[i]));
  }
  const auto larger = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto worst =
      static_cast<std::size_t>(std::ranges::max_element(bias, larger) - bias.begin());
  EXPECT_EQ(samples[33].values, samples[worst].values);
  EXPECT_EQ(channels[33].name, "worst");
}

TEST(Reconstruction, CostsItsSamplesAndThePass) {
  const auto plan = reconstruction_plan(wave("8"));
  const Cost cost = observe_one(prepare("depth_of_field/reconstruction", wave("8")), 3).cost;
  EXPECT_EQ(cost.camera_rays, 3 * (33 + std::reduce(plan.counts.begin(), plan.counts.end())));
  EXPECT_EQ(cost.samples, 3u);
}

}  // namespace
}  // namespace assay::depth_of_field
