// Each mutant of depth of field against quadrature, against sums over all ways that samples can
// fall, or against the same picture worked out from the plan.

#include "tests/estimators/depth_of_field/plans.h"
#include "tests/estimators/prelude.h"

namespace assay::depth_of_field {
namespace {

// Radius xi: the part of the lens within 1/2 gets half of the points, not a fourth.
TEST(LensMutants, CrowdedPointsAreInTheSamplerToo) {
  for (const auto& [plugin, inside] :
       {std::pair<const char*, double>{"depth_of_field/pixel", .25},
        std::pair<const char*, double>{"mutants/lens_crowded", .5}}) {
    const auto sampler = prepare(plugin).sampler();
    Stream random(stream_key(1, plugin, "", 0), 0);
    const int count = 20000;
    int found = 0;
    for (int i = 0; i < count; ++i) {
      const Point w = sampler->sample(random).point;
      found += w[0] * w[0] + w[1] * w[1] < .25;
    }
    EXPECT_NEAR(found, inside * count, five * std::sqrt(count * inside * (1 - inside))) << plugin;
  }
}

// False alarm 1e-6 for each of the 96 pixels.
TEST(LensMutants, DividedByTheMeanNumberPixelsAreOffByTheirShareOfSamples) {
  const std::string parameters = "{scene: strip, width: 24, height: 4}";
  const ImagePlan plan = image_plan(parameters);
  double mean = 0;
  for (const std::uint64_t n : plan.counts) mean += static_cast<double>(n) / 96;
  const auto samples = observe(prepare("mutants/lens_divided_by_mean", parameters), 4000);
  double most = 0;
  for (std::size_t i = 0; i < 96; ++i) {
    const double factor = static_cast<double>(plan.counts[i]) / mean;
    EXPECT_THAT(samples[i], HasMean(plan.exact[i].mean * factor, 1e-9)) << i;
    most = std::max(most, factor);
  }
  EXPECT_GT(most, 2);
}

// The board's penumbra on the background is cut off; what the middle sees of the board stays.
// False alarm 1e-6 for each of the 24 pixels.
TEST(LensMutants, ASharpBackgroundHasNothingOfTheBoardBeforeIt) {
  const std::string parameters =
      "{scene: {lens: {radius: .2, focus: 2}, background: .2, planes: [{depth: 1, x: [-.15, .2], "
      "y: "
      "[-100, 100], radiance: 1}]}, width: 24, height: 1}";
  const ImagePlan plan = image_plan(parameters);
  const auto samples = observe(prepare("mutants/lens_sharp_background", parameters), 4000);
  std::size_t cut = 0;
  for (std::size_t i = 0; i < 24; ++i) {
    const double x = plan.grid.pixel(i).x / 2;
    const bool board = x > -.15 && x < .2;
    EXPECT_THAT(samples[i], HasMean(board ? plan.exact[i].mean : .2, 1e-12)) << i;
    cut += !board && plan.exact[i].mean > .21;
  }
  EXPECT_GT(cut, 2u);
}

// One sample where the sound image has most, hence the variance of one.
TEST(LensMutants, WithFrontsIgnoredEveryPixelOfAnEdgeHasOneSample) {
  const std::string parameters = "{scene: edge, width: 60, height: 1, samples: 32}";
  const Prepared mutant = prepare("mutants/lens_fronts_ignored", parameters);
  const ImagePlan plan = image_plan(parameters);
  const auto channels = mutant.setup->channels();
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(channels[i].mean, plan.exact[i].mean);
    if (!channels[i].variance) continue;
    EXPECT_DOUBLE_EQ(*channels[i].variance, plan.exact[i].variance());
  }
  EXPECT_GT(*channels[60].variance, .24);
  EXPECT_EQ(observe_one(mutant, 1).cost.camera_rays, 60u + 70);
}

// Edges behind the focal plane it sees.
TEST(LensMutants, WithFrontsIgnoredEdgesBehindAreSeen) {
  const std::string parameters =
      "{scene: {lens: {radius: .2, focus: 2}, planes: [{depth: 3, x: [0, 100], y: [-100, 100], "
      "radiance: 1}]}, width: 40, height: 1}";
  EXPECT_EQ(prepare("mutants/lens_fronts_ignored", parameters).channel(40).variance,
            prepare("depth_of_field/image", parameters).channel(40).variance);
}

// Its image is that of samples eight pixels apart. A sound one takes them at every fourth pixel of
// 1 / 57, since two a period of the wave are pi / 30 = 5.97 pixels apart. False alarm 1e-6 for each
// of the 57 pixels.
TEST(LensMutants, ASignedMaximumSamplesWavesEightPixelsApart) {
  const std::string common = "scene: sinusoid, width: 57, height: 1, size: 1";
  const auto plan = reconstruction_plan("{" + common + ", spacing: 8}");
  const auto sound = reconstruction_plan("{" + common + "}");
  const std::vector<double> bias = plan.bias();
  const auto samples = observe(prepare("mutants/bandwidth_signed", "{" + common + "}"), 10000);
  double most = 0;
  for (std::size_t i = 0; i < 57; ++i) {
    EXPECT_THAT(samples[i], HasMean(plan.exact[i].mean + bias[i]));
    most = std::max(most, std::abs(bias[i]));
  }
  EXPECT_GT(most, .1);
  EXPECT_EQ(plan.samples.size(), 8u);
  EXPECT_EQ(sound.samples.size(), 15u);
}

// Beyond the last sample, where a tent falls off; elsewhere nothing is wrong with one spacing.
// False alarm 1e-6 for each of the 64 pixels.
TEST(LensMutants, UnnormalisedSplatsFadeBeyondTheLastSample) {
  const std::string parameters = "{scene: sinusoid, width: 64, height: 1, size: .4, spacing: 8}";
  const auto plan = reconstruction_plan(parameters);
  const std::vector<double> bias = plan.bias();
  const auto samples = observe(prepare("mutants/splats_unnormalised", parameters), 10000);
  for (std::size_t i = 0; i < 64; ++i) {
    const double left = i < 56 ? 1 : 1 - static_cast<double>(i - 56) / 8;
    EXPECT_THAT(samples[i], HasMean(left * (plan.exact[i].mean + bias[i]))) << i;
  }
}

}  // namespace
}  // namespace assay::depth_of_field
