// Pixels of images that never varied, and those of which one half of the images saw nothing.

#include "harness/image/image_evidence.h"
#include "harness/question/question.h"
#include "tests/harness/questions.h"
#include "tests/stats/calibration.h"

namespace assay::harness {
namespace {

using reports::Verdict;

// Values from 0.02 to 8, in single precision, means to about 1e-16.
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
constexpr std::size_t dark = 16 * 24 + 6;  // its mean is 0.0250, in 64 images it may stay at 0.02

using Stack = std::vector<std::vector<float>>;

/// The next larger number: half a unit in the last place may be an image's, half another's.
void round_up(float& value) { value = std::nextafter(value, std::numeric_limits<float>::max()); }

class Constants : public testing::Test {
 protected:
  /// Images that are the reference everywhere.
  Stack at_reference(std::size_t count) const {
    std::vector<float> image;
    for (const Constant& reference : asked_->questions[0].references) {
      image.push_back(static_cast<float>(reference.value));
    }
    return Stack(count, image);
  }

  /// The sides of a test, whose constants are settled.
  struct Settled {
    const ImagePair& pair;
    stats::ImageConstants constants;
    bool any_varies() const { return constants.count < pair.first.extent.elements(); }
  };
  Settled settled(std::size_t test, std::vector<Stack> sides) {
    data_.resize(sides.size());
    for (std::size_t i = 0; i < sides.size(); ++i) {
      data_[i].images = ImageViews(std::move(sides[i]));
    }
    pair_.emplace(Seen{asked_->questions[test], 0, data_});
    return {*pair_, pair_->settle(asked_->questions[test])};
  }

  std::unique_ptr<Asked> asked_ = ask_text(suite);
  std::vector<ChannelData> data_;
  std::optional<ImagePair> pair_;
};

TEST_F(Constants, AConstantWithinRoundingOfItsReferenceIsAtIt) {
  Stack images = at_reference(64);
  for (auto& image : images) round_up(image[dark]);
  round_up(images[5][7]);  // varies, but not by more than rounding
  images[5][8] += 1e-3F;
  const Settled part = settled(0, {images});
  EXPECT_TRUE(part.any_varies());
  EXPECT_TRUE(part.constants.unseen.empty());
  for (const std::size_t i : {std::size_t{3}, std::size_t{7}, dark}) {
    for (const auto& image : part.pair.first.images) EXPECT_EQ(image[i], part.pair.value[i]);
  }
  EXPECT_NE(part.pair.first.images[5][8], part.pair.value[8]);
}

// The references of other pixels have errors of 1e-16 to 1e-12, which are no spread of this one.
TEST_F(Constants, APixelThatWasNeverLitIsHeldAgainstItsRangeAlone) {
  const Constant& reference = asked_->questions[0].references[dark];
  ASSERT_NEAR(reference.value, 0.025014548794971263, 1e-15);
  ASSERT_GT(reference.standard_error, 0);
  Stack images = at_reference(64);
  for (auto& image : images) image[dark] = 0.02F;
  const Settled part = settled(0, {images});
  EXPECT_FALSE(part.any_varies());
  ASSERT_EQ(part.constants.unseen.size(), 1u);
  EXPECT_EQ(part.constants.unseen[0].element, dark);
  EXPECT_EQ(part.constants.unseen[0].sign, -1);
  EXPECT_NEAR(part.constants.unseen[0].log_p, 64 * std::log1p(-0.005014548794971263 / 7.98), 1e-8);
  // Sums with its neighbours see it where it is.
  EXPECT_EQ(part.pair.value[dark], reference.value);
}

TEST_F(Constants, BeyondTheRangeAConstantIsCertainlyWrong) {
  Stack images = at_reference(64);
  for (auto& image : images) image[17 * 24] = 8;  // where nothing but the background is seen
  const Settled part = settled(0, {images});
  ASSERT_EQ(part.constants.unseen.size(), 1u);
  EXPECT_LT(part.constants.unseen[0].log_p, std::log(1e-100));
  EXPECT_GT(part.constants.unseen[0].z(), 20);
}

// Different constants are the pyramid's matter.
TEST_F(Constants, OfTwoImagesAndOfPairsAreEqualWithinRoundingOnly) {
  const Stack first = at_reference(16);
  Stack second = first;
  for (auto& image : second) {
    round_up(image[3]);
    image[4] *= 1 + 1e-6F;
  }
  Stack varied = first;
  round_up(varied[2][5]);
  const Settled two = settled(2, {varied, second});
  const auto& a = two.pair.first.images;
  const auto& b = two.pair.second.value().images;
  for (std::size_t r = 0; r < a.size(); ++r) {
    EXPECT_EQ(a[r][3], b[r][3]);
    EXPECT_NE(a[r][4], b[r][4]);
    EXPECT_EQ(a[r][5], b[r][5]);
  }
  const Settled pairs = settled(3, {first, second});
  EXPECT_TRUE(pairs.any_varies());
  EXPECT_TRUE(pairs.constants.unseen.empty());
  for (const auto& image : pairs.pair.first.images) {
    EXPECT_EQ(image[3], pairs.pair.value[3]);
    EXPECT_NE(image[4], pairs.pair.value[4]);
  }
}

// One image never lit a pixel, and the other did now and then; that is no contradiction. At 0.0052
// above 0.02 a value of 8 has probability 0.0007.
TEST_F(Constants, APixelThatOneOfTwoImagesNeverLitIsHeldAgainstItsRange) {
  Stack first = at_reference(16);
  Stack second = first;
  for (std::size_t r = 0; r < 16; ++r) {
    first[r][dark] = 0.02F;
    second[r][dark] = 0.025F + 0.0001F * static_cast<float>(r % 5);
  }
  const Settled part = settled(2, {first, second});
  ASSERT_EQ(part.constants.unseen.size(), 1u);
  EXPECT_EQ(part.constants.unseen[0].sign, -1);
  EXPECT_NEAR(part.constants.unseen[0].log_p, 16 * std::log1p(-0.0052 / 7.98), 1e-3);
}

// The float next to 0.1 is 1.5e-9 above it.
TEST(ImageRounding, IsNeitherBeyondARangeNorADifferenceFromTheMean) {
  const Entry entry{};
  const PreparedEstimator estimator{
      .entry = &entry,
      .setup = assay::setup_of(SetupParts{.image = ImageShape{.width = 1, .height = 1},
                                          .elements = {{.mean = 0.1, .low = 0, .high = 0.1}}})};
  Question question;
  question.subjects.push_back(
      {.estimator = &estimator, .setup = estimator.setup, .channels = {0, 1, 1}});
  Summary drawn(1);
  drawn.channels[0].moments.add(double{0.1F});
  EXPECT_EQ(outside_of_range(question.subjects[0], drawn), "");
  EXPECT_LE(double{0.1F} - 0.1, rounding_of(question.subjects[0], 0));
  EXPECT_LT(rounding_of(question.subjects[0], 0), 1e-8);
  drawn.channels[0].moments.add(0.1 + 1e-7);
  EXPECT_NE(outside_of_range(question.subjects[0], drawn), "");
}

// 147 of 432 pixels see one surface that is alike everywhere. Their values differ from the closed
// form by rounding, up to 1.5e-15. False alarm 1e-5 at each seed.
TEST_F(Constants, PixelsThatAreConstantAreNoEvidence) {
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
