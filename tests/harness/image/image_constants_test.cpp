// Pixels of images that never varied, and those of which one half of the images saw nothing.

#include "harness/image/image_constants.h"

#include "tests/harness/questions.h"
#include "tests/prelude.h"
#include "tests/stats/calibration.h"

namespace assay::harness {
namespace {

using reports::Verdict;

// Values from 0.02 to 8, rounding 8 x 2^-40, means to about 1e-16.
constexpr const char* suite = R"(suite: constants
alpha: 0.00001
estimators:
  predicted: {plugin: depth_of_field/image, scene: portrait, width: 24, height: 18, samples: 32, primaries: 1}
  uniform: {plugin: depth_of_field/image, scene: portrait, width: 24, height: 18, samples: 32, allocation: uniform, primaries: 1}
tests:
  - claim: mean(predicted) == analytic
  - claim: mean(uniform) == analytic
  - {name: two, claim: mean(predicted) == mean(uniform)}
  - {name: pairs, claim: mean(predicted) == mean(uniform), paired: true}
)";
constexpr std::size_t replicates = 64;
constexpr double rounding = 8 * 0x1p-40;
constexpr std::size_t dark = 16 * 24 + 6;  // its mean is 0.0250, in 64 images it may stay at 0.02

using Images = std::vector<std::vector<double>>;

/// Images that are the reference everywhere.
Images at_reference(const Question& question, std::size_t count = replicates) {
  std::vector<double> image;
  for (const Constant& reference : question.references) image.push_back(reference.value);
  return Images(count, image);
}

std::vector<ChannelData> data_of(std::vector<Images> sides) {
  std::vector<ChannelData> data(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) data[i].images = ImageViews(std::move(sides[i]));
  return data;
}

TEST(ImageConstants, AConstantWithinRoundingOfItsReferenceIsAtIt) {
  const auto asked = ask_text(suite);
  const Question& question = asked->questions[0];
  Images images = at_reference(question);
  for (auto& image : images) {
    image[3] -= 5e-16;
    image[dark] += 0.9 * rounding;
  }
  images[5][7] += rounding;  // varies, but not by more than rounding
  images[5][8] += 1e-3;
  const std::vector<ChannelData> data = data_of({images});
  const ImagePair<double> pair(question, data);
  const VaryingPart varying(question, pair);
  EXPECT_TRUE(varying.any());
  EXPECT_TRUE(varying.unseen().empty());
  varying.with([&](const auto& a, const auto& b) {
    if constexpr (requires { b.value; }) {
      for (const std::size_t i : {std::size_t{3}, std::size_t{7}, dark}) {
        for (const auto& image : a.images) EXPECT_EQ(image[i], b.value[i]);
      }
      EXPECT_NE(a.images[5][8], b.value[8]);
    }
  });
}

// The references of other pixels have errors of 1e-16 to 1e-12, which are no spread of this one.
TEST(ImageConstants, APixelThatWasNeverLitIsHeldAgainstItsRangeAlone) {
  const auto asked = ask_text(suite);
  const Question& question = asked->questions[0];
  ASSERT_NEAR(question.references[dark].value, 0.025014548794971263, 1e-15);
  ASSERT_GT(question.references[dark].standard_error, 0);
  Images images = at_reference(question);
  for (auto& image : images) image[dark] = 0.02;
  const std::vector<ChannelData> data = data_of({images});
  const ImagePair<double> pair(question, data);
  const VaryingPart varying(question, pair);
  EXPECT_FALSE(varying.any());
  ASSERT_EQ(varying.unseen().size(), 1u);
  EXPECT_EQ(varying.unseen()[0].element, dark);
  EXPECT_EQ(varying.unseen()[0].sign, -1);
  EXPECT_NEAR(varying.unseen()[0].log_p, 64 * std::log1p(-0.005014548794971263 / 7.98), 1e-9);
}

TEST(ImageConstants, BeyondTheRangeAConstantIsCertainlyWrong) {
  const auto asked = ask_text(suite);
  const Question& question = asked->questions[0];
  Images images = at_reference(question);
  for (auto& image : images) image[17 * 24] = 8;  // where nothing but the background is seen
  const std::vector<ChannelData> data = data_of({images});
  const ImagePair<double> pair(question, data);
  const VaryingPart varying(question, pair);
  ASSERT_EQ(varying.unseen().size(), 1u);
  EXPECT_LT(varying.unseen()[0].log_p, std::log(1e-100));
  EXPECT_GT(z_of(varying.unseen()[0]), 20);
}

TEST(ImageConstants, ConstantsOfTwoImagesAreEqualWithinRoundingOnly) {
  const auto asked = ask_text(suite);
  const Question& question = asked->question("two");
  const Question& of_one = asked->questions[0];
  Images first = at_reference(of_one, 16);
  Images second = first;
  for (auto& image : second) {
    image[3] += rounding;
    image[4] += 4 * rounding;
  }
  first[2][5] += rounding;
  const std::vector<ChannelData> data = data_of({first, second});
  const ImagePair<double> pair(question, data);
  const VaryingPart varying(question, pair);
  varying.with([&](const auto& a, const auto& b) {
    if constexpr (requires { b.images; }) {
      for (std::size_t r = 0; r < a.images.size(); ++r) {
        EXPECT_EQ(a.images[r][3], b.images[r][3]);
        EXPECT_NE(a.images[r][4], b.images[r][4]);
        EXPECT_EQ(a.images[r][5], b.images[r][5]);
      }
    }
  });
}

// As constants of two images that differ fail, a difference that never varies stays as it is.
TEST(ImageConstants, ADifferenceOfPairsThatNeverVariesIsNotSettled) {
  const auto asked = ask_text(suite);
  const Question& question = asked->question("pairs");
  Images first = at_reference(asked->questions[0], 16);
  Images second = first;
  for (auto& image : second) {
    image[3] += rounding;
    image[4] += 4 * rounding;
  }
  const std::vector<ChannelData> data = data_of({first, second});
  const ImagePair<double> pair(question, data);
  const VaryingPart varying(question, pair);
  EXPECT_TRUE(varying.any());
  EXPECT_TRUE(varying.unseen().empty());
  varying.with([&](const auto& a, const auto& b) {
    if constexpr (requires { b.value; }) {
      for (const auto& image : a.images) {
        EXPECT_EQ(image[3], b.value[3]);
        EXPECT_NE(image[4], b.value[4]);
      }
    }
  });
}

// One image never lit a pixel, and the other did now and then; that is no contradiction. At 0.0052
// above 0.02 a value of 8 has probability 0.0007.
TEST(ImageConstants, APixelThatOneOfTwoImagesNeverLitIsHeldAgainstItsRange) {
  const auto asked = ask_text(suite);
  const Question& question = asked->question("two");
  Images first = at_reference(asked->questions[0], 16);
  Images second = first;
  for (std::size_t r = 0; r < 16; ++r) {
    first[r][dark] = 0.02;
    second[r][dark] = 0.025 + 0.0001 * static_cast<double>(r % 5);
  }
  const std::vector<ChannelData> data = data_of({first, second});
  const ImagePair<double> pair(question, data);
  const VaryingPart varying(question, pair);
  ASSERT_EQ(varying.unseen().size(), 1u);
  EXPECT_EQ(varying.unseen()[0].sign, -1);
  EXPECT_NEAR(varying.unseen()[0].log_p, 16 * std::log1p(-0.0052 / 7.98), 1e-3);
}

// 147 of 432 pixels see one surface that is alike everywhere. Their values differ from the closed
// form by rounding, up to 1.5e-15. False alarm 1e-5 at each seed.
TEST(ImageConstants, PixelsThatAreConstantAreNoEvidence) {
  const Workplace place;
  const std::string file = place.write("suite.yaml", R"(suite: uniform
alpha: 0.00001
estimators:
  uniform: {plugin: depth_of_field/image, scene: portrait, width: 24, height: 18, samples: 32, allocation: uniform, primaries: 1}
tests:
  - claim: mean(uniform) == analytic
)");
  for (std::uint64_t seed = 1; seed <= (tests::is_long() ? 3 : 1); ++seed) {
    const reports::Record record = run_files({file}, {.seed = seed});
    const reports::Test& test = record.suites[0].tests.at(0);
    EXPECT_EQ(test.verdict, Verdict::pass) << seed << ' ' << test.message;
    EXPECT_GT(test.image->constant, 100u);
  }
}

}  // namespace
}  // namespace assay::harness
