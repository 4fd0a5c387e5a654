// Images with a number of lens samples for each pixel: what is planned, and what is drawn.


#include "tests/estimators/depth_of_field/plans.h"
#include "tests/estimators/prelude.h"

namespace assay::depth_of_field {
namespace {

const std::string edge_row = "scene: edge, width: 12, height: 1, size: 0.5, samples: 6";

TEST(LensImagePlan, AllotsByTheExponentOfItsName) {
  std::vector<double> variances;
  for (const Moments& m : image_plan("{" + edge_row + "}").exact)
    variances.push_back(m.mean * (1 - m.mean));
  std::vector<std::vector<std::uint64_t>> seen;
  for (const auto& [allocation, exponent] :
       {std::pair{"uniform", 0.}, {"deviation", .5}, {"two_thirds", 2. / 3}, {"variance", 1.}}) {
    const ImagePlan plan =
        image_plan("{" + edge_row + ", prediction: exact, allocation: " + allocation + "}");
    EXPECT_EQ(plan.counts, lens_counts(variances, {6, exponent})) << allocation;
    EXPECT_EQ(plan.overhead.camera_rays, 0u);
    seen.push_back(plan.counts);
  }
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_NE(seen[i], seen[i - 1]);
}

TEST(LensImagePlan, PaysForAPredictionOnlyWhereItAsksForOne) {
  EXPECT_EQ(image_plan("{" + edge_row + "}").overhead.camera_rays, 12u + 10);
  EXPECT_EQ(image_plan("{" + edge_row + ", prediction: covariance}").overhead.camera_rays,
            12u + 10);
  EXPECT_EQ(image_plan("{" + edge_row + ", allocation: uniform}").overhead.camera_rays, 0u);
}

TEST(LensImagePlan, CountsOfAPredictionAreThoseOfItsVariance) {
  const std::string grid = "width: 10, height: 8, samples: 20";
  const ImagePlan waves = image_plan("{scene: boards, " + grid + "}");
  const ImagePlan gauss = image_plan("{scene: boards, prediction: covariance, " + grid + "}");
  const auto counts = [&](const PredictionRules& rules) {
    return lens_counts(predict(*waves.setting, waves.grid, rules).variance, {20});
  };
  EXPECT_EQ(waves.counts, counts(wave_rules()));
  EXPECT_EQ(gauss.counts, counts(covariance_rules()));
  EXPECT_NE(waves.counts, gauss.counts);
}

TEST(LensImagePlan, TheExtremesAreThoseOfNoiseAboveZero) {
  ImagePlan plan;
  // Variances 0.25, 0, 0.16, 0.21 of black and white; noise 0.05, 0, 0.02, 0.07.
  for (const double mean : {.5, 1., .2, .3}) plan.exact.push_back({.mean = mean, .square = mean});
  plan.counts = {5, 1, 8, 3};
  EXPECT_EQ(noise_extremes(plan).worst, 3u);
  EXPECT_EQ(noise_extremes(plan).quietest, 2u);
}

TEST(LensImage, PixelsHaveTheirExactMeansAndTheVarianceOfTheirCounts) {
  const ImagePlan plan = image_plan("{" + edge_row + "}");
  const auto channels = prepare("depth_of_field/image", "{" + edge_row + "}").setup->channels();
  std::size_t noisy = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    const double c = half_plane_coverage(-plan.grid.pixel(i).x / .2);
    const double noise = c * (1 - c) / static_cast<double>(plan.counts[i]);
    EXPECT_NEAR(*channels[i].mean, c, 1e-12);
    if (noise == 0) continue;
    ++noisy;
    EXPECT_NEAR(*channels[i].variance, noise, 1e-9 * noise);
  }
  EXPECT_EQ(noisy, 10u);
}

TEST(LensImage, ItsDiagnosticChannelsRepeatPixels) {
  const NoiseExtremes ends = noise_extremes(image_plan("{" + edge_row + "}"));
  const Prepared image = prepare("depth_of_field/image", "{" + edge_row + "}");
  const auto channels = image.setup->channels();
  ASSERT_EQ(channels.size(), 14u);
  EXPECT_EQ(channels[12].name, "worst");
  EXPECT_EQ(channels[13].name, "quietest");
  EXPECT_EQ(channels[12].variance, channels[ends.worst].variance);
  EXPECT_GT(*channels[12].variance, *channels[13].variance);
  const auto samples = observe(image, 50);
  EXPECT_EQ(samples[12].values, samples[ends.worst].values);
  EXPECT_EQ(samples[13].values, samples[ends.quietest].values);
  EXPECT_NE(samples[12].values, samples[13].values);
}

// With 4 primaries a pixel has 4 N samples, and the pass is counted 4 times.
TEST(LensImage, APrimaryIsAnImageAndItsPass) {
  const ImagePlan plan = image_plan("{" + edge_row + "}");
  const Prepared image = prepare("depth_of_field/image", "{" + edge_row + "}");
  const auto [out, cost] = observe_one(image, 4);
  EXPECT_EQ(cost.camera_rays, 4 * (std::reduce(plan.counts.begin(), plan.counts.end()) + 12 + 10));
  EXPECT_EQ(cost.samples, 4u);
  for (std::size_t i = 0; i < 12; ++i) {
    const double lit = out[i] * 4 * static_cast<double>(plan.counts[i]);
    EXPECT_NEAR(lit, std::round(lit), 1e-9);
  }
}

}  // namespace
}  // namespace assay::depth_of_field
