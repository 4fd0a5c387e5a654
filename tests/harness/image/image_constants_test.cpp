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
constexpr double rounding = 8 * 0x1p-40;
constexpr std::size_t dark = 16 * 24 + 6;  // its mean is 0.0250, in 64 images it may stay at 0.02

using Images = std::vector<std::vector<double>>;

class ImageConstants : public testing::Test {
 protected:
  /// Images that are the reference everywhere.
  Images at_reference(std::size_t count) const {
    std::vector<double> image;
    for (const Constant& reference : asked_->questions[0].references) {
      image.push_back(reference.value);
    }
    return Images(count, image);
  }

  /// What varies of these sides of a test.
  VaryingPart<double> varying(std::size_t test, std::vector<Images> sides) {
    data_.resize(sides.size());
    for (std::size_t i = 0; i < sides.size(); ++i) {
      data_[i].images = ImageViews(std::move(sides[i]));
    }
    pair_.emplace(Seen{asked_->questions[test], 0, data_});
    return VaryingPart<double>(asked_->questions[test], *pair_);
  }

  std::unique_ptr<Asked> asked_ = ask_text(suite);
  std::vector<ChannelData> data_;
  std::optional<ImagePair<double>> pair_;
};

TEST_F(ImageConstants, AConstantWithinRoundingOfItsReferenceIsAtIt) {
  Images images = at_reference(64);
  for (auto& image : images) {
    image[3] -= 5e-16;
    image[dark] += 0.9 * rounding;
  }
  images[5][7] += rounding;  // varies, but not by more than rounding
  images[5][8] += 1e-3;
  const VaryingPart<double> part = varying(0, {images});
  EXPECT_TRUE(part.any());
  EXPECT_TRUE(part.unseen().empty());
  part.with([&](const auto& a, const auto& b) {
    if constexpr (requires { b.value; }) {
      for (const std::size_t i : {std::size_t{3}, std::size_t{7}, dark}) {
        for (const auto& image : a.images) EXPECT_EQ(image[i], b.value[i]);
      }
      EXPECT_NE(a.images[5][8], b.value[8]);
    }
  });
}

// The references of other pixels have errors of 1e-16 to 1e-12, which are no spread of this one.
TEST_F(ImageConstants, APixelThatWasNeverLitIsHeldAgainstItsRangeAlone) {
  const Constant& reference = asked_->questions[0].references[dark];
  ASSERT_NEAR(reference.value, 0.025014548794971263, 1e-15);
  ASSERT_GT(reference.standard_error, 0);
  Images images = at_reference(64);
  for (auto& image : images) image[dark] = 0.02;
  const VaryingPart<double> part = varying(0, {images});
  EXPECT_FALSE(part.any());
  ASSERT_EQ(part.unseen().size(), 1u);
  EXPECT_EQ(part.unseen()[0].element, dark);
  EXPECT_EQ(part.unseen()[0].sign, -1);
  EXPECT_NEAR(part.unseen()[0].log_p, 64 * std::log1p(-0.005014548794971263 / 7.98), 1e-9);
  // Sums with its neighbours see it where it is.
  part.with([&](const auto&, const auto& b) {
    if constexpr (requires { b.value; }) {
      EXPECT_EQ(b.value[dark], reference.value);
    }
  });
}

TEST_F(ImageConstants, BeyondTheRangeAConstantIsCertainlyWrong) {
  Images images = at_reference(64);
  for (auto& image : images) image[17 * 24] = 8;  // where nothing but the background is seen
  const VaryingPart<double> part = varying(0, {images});
  ASSERT_EQ(part.unseen().size(), 1u);
  EXPECT_LT(part.unseen()[0].log_p, std::log(1e-100));
  EXPECT_GT(z_of(part.unseen()[0]), 20);
}

// As constants of two images that differ fail, a difference of pairs that never varies stays as it
// is.
TEST_F(ImageConstants, OfTwoImagesAndOfPairsAreEqualWithinRoundingOnly) {
  const Images first = at_reference(16);
  Images second = first;
  for (auto& image : second) {
    image[3] += rounding;
    image[4] += 4 * rounding;
  }
  Images varied = first;
  varied[2][5] += rounding;
  varying(2, {varied, second}).with([&](const auto& a, const auto& b) {
    if constexpr (requires { b.images; }) {
      for (std::size_t r = 0; r < a.images.size(); ++r) {
        EXPECT_EQ(a.images[r][3], b.images[r][3]);
        EXPECT_NE(a.images[r][4], b.images[r][4]);
        EXPECT_EQ(a.images[r][5], b.images[r][5]);
      }
    }
  });
  const VaryingPart<double> pairs = varying(3, {first, second});
  EXPECT_TRUE(pairs.any());
  EXPECT_TRUE(pairs.unseen().empty());
  pairs.with([&](const auto& a, const auto& b) {
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
TEST_F(ImageConstants, APixelThatOneOfTwoImagesNeverLitIsHeldAgainstItsRange) {
  Images first = at_reference(16);
  Images second = first;
  for (std::size_t r = 0; r < 16; ++r) {
    first[r][dark] = 0.02;
    second[r][dark] = 0.025 + 0.0001 * static_cast<double>(r % 5);
  }
  const VaryingPart<double> part = varying(2, {first, second});
  ASSERT_EQ(part.unseen().size(), 1u);
  EXPECT_EQ(part.unseen()[0].sign, -1);
  EXPECT_NEAR(part.unseen()[0].log_p, 16 * std::log1p(-0.0052 / 7.98), 1e-3);
}

// 147 of 432 pixels see one surface that is alike everywhere. Their values differ from the closed
// form by rounding, up to 1.5e-15. False alarm 1e-5 at each seed.
TEST_F(ImageConstants, PixelsThatAreConstantAreNoEvidence) {
  for (std::uint64_t seed = 1; seed <= (tests::is_long() ? 3 : 1); ++seed) {
    const reports::Record record =
        run_text(suite, {.seed = seed, .selection = {.filters = {"*mean(uniform) == analytic"}}});
    const reports::Test& test = record.suites[0].tests.at(0);
    expect_said(test, Verdict::pass);
    EXPECT_GT(test.image->constant, 100u);
  }
}

}  // namespace
}  // namespace assay::harness
