// Evidence about images whose pixels depend on each other, or have rare lights.

#include "harness/image/image_evidence.h"

#include "tests/harness/questions.h"
#include "tests/stats/calibration.h"

namespace assay::harness {
namespace {

constexpr std::size_t width = 16;
constexpr std::size_t replicates = 64;
constexpr double alpha = 0.05;

constexpr const char* dependent =
    "suite: s\nestimators: {it: {plugin: analytic/ramp, shared: true}}\n"
    "tests: [{name: t, claim: mean(it) == 1}]\n";

/// One more observation of 256 pixels.
using DrawImage = std::function<void(Philox&, std::vector<double>&)>;

/// The mean is 1 everywhere. Two columns hold a firefly of 14 standard deviations in one pixel
/// of 7.
void fireflies_in_two_columns(Philox& random, std::vector<double>& image) {
  constexpr double chance = 1 / 7.0;
  constexpr double light = 0.34;
  for (std::size_t i = 0; i < image.size(); ++i) {
    image[i] = 1 + 0.025 * random.normal();
    if (i % width < 2) image[i] += (random.uniform() < chance ? light : 0) - chance * light;
  }
}

void shared_noise(Philox& random, std::vector<double>& image) {
  const double common = random.normal();
  for (double& pixel : image) pixel = 1 + 0.1 * (common + random.normal());
}

/// One of twenty pictures is black: the mean is .95.
void black_now_and_then(Philox& random, std::vector<double>& image) {
  const double light = random.uniform() < 0.05 ? 0 : 1;
  for (double& pixel : image) pixel = light * (1 + 0.1 * random.normal());
}

/// The mean is one standard error above 1, that of the mean of all images.
void brighter_by_an_error(Philox& random, std::vector<double>& image) {
  shared_noise(random, image);
  for (double& pixel : image) pixel += 0.1 / std::sqrt(replicates);
}

ChannelEvidence evidence_of(std::uint32_t key, const DrawImage& draw) {
  const auto asked = ask_text(dependent);
  const Question& question = asked->question("t");
  std::vector<std::vector<float>> images(replicates);
  Philox random(key);
  std::vector<double> drawn(width * width);
  for (std::vector<float>& image : images) {
    draw(random, drawn);
    for (const double value : drawn) image.push_back(static_cast<float>(value));
  }
  ChannelData data[1];
  data[0].images = ImageViews(std::move(images));
  const ImageTest test{.share = {.alpha = alpha, .beta = alpha}};
  return evidence_of_images({question, 0, data}, test);
}

// Wrong alarms: 2.5e-6 each.
TEST(ImageEvidence, RareLightsAndSharedNoiseKeepTheLevel) {
  for (const DrawImage& draw : {DrawImage(fireflies_in_two_columns), DrawImage(shared_noise)}) {
    constexpr std::uint32_t keys = 100;
    double failed = 0;
    for (std::uint32_t key = 1; key <= keys; ++key) {
      failed += evidence_of(key, draw).image.value().family.log_p <= std::log(alpha);
    }
    EXPECT_FALSE(tests::too_many(failed / keys, alpha, keys)) << failed;
  }
}

// Wrong alarms: 2.5e-6 each. By the squared distance alone about a fifth pass.
TEST(ImageEvidence, DifferencesOfWholePicturesSeldomPass) {
  const std::pair<DrawImage, double> margins[] = {
      {black_now_and_then, 0.02}, {brighter_by_an_error, 0.1 / std::sqrt(replicates)}};
  for (const auto& [draw, margin] : margins) {
    constexpr std::uint32_t keys = 300;
    double passed = 0;
    for (std::uint32_t key = 1; key <= keys; ++key) {
      passed += evidence_of(key, draw).evidence.at(margin).log_p_lower <= std::log(alpha);
    }
    EXPECT_FALSE(tests::too_many(passed / keys, alpha, keys)) << passed;
  }
}

}  // namespace
}  // namespace assay::harness
