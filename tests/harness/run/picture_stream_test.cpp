// Claims on two stacks of pictures that are taken rows after rows.

#include <fmt/format.h>

#include "harness/run/planned_run.h"
#include "harness/theta/ask.h"
#include "tests/estimators/exr.h"
#include "tests/harness/prelude.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

// So wide that 64 of them are taken in three windows.
constexpr int width = 172;
constexpr int height = 150;
constexpr int streamed_pictures = 32;  // a side

void expect_same_findings(const reports::Test& one, reports::Test other) {
  EXPECT_EQ(one.channels[0].log10_p, other.channels[0].log10_p);
  EXPECT_EQ(one.channels[0].effect.low, other.channels[0].effect.low);
  EXPECT_EQ(one.detectable, other.detectable);
  EXPECT_EQ(one.image->groups, other.image->groups);
  EXPECT_EQ(one.gates, other.gates);
  EXPECT_EQ(one.maps, other.maps);
  ASSERT_EQ(one.samples.size(), other.samples.size());
  for (std::size_t i = 0; i < one.samples.size(); ++i) {
    other.samples[i].cost.seconds = one.samples[i].cost.seconds;
    EXPECT_EQ(one.samples[i], other.samples[i]);
  }
}

class PictureStream : public InFolder {
 protected:
  PictureStream() {
    for (int i = 0; i < streamed_pictures; ++i) {
      write('a', i, noise());
      write('b', i, noise());
    }
  }

  draws::Picture noise() {
    draws::Picture picture{width, height, {"R", "G", "B"}, {}};
    for (int texel = 0; texel < width * height * 3; ++texel) {
      const double value = random_.uniform();
      picture.values.push_back(texel % 5 == 0 && value < 0.9 ? 0 : static_cast<float>(value));
    }
    return picture;
  }

  void write(char side, int index, const draws::Picture& picture) const {
    draws::write_exr(place_.file(fmt::format("{}{:02}.exr", side, index)), picture);
  }

  /// A suite with these lines after `claim: mean(a) == mean(b)`.
  Suite suite(const std::string& lines = "") const {
    return load_suite(place_.write(
        "suite.yaml",
        "suite: s\nestimators:\n  a: {plugin: recorded, file: 'a*.exr'}\n"
        "  b: {plugin: recorded, file: 'b*.exr'}\ntests:\n  - claim: mean(a) == mean(b)\n" +
            lines));
  }

  bool streams(const std::string& lines) const {
    const PlannedRun planned = plan_run({suite(lines)}, {}, silence);
    return planned.suites[0]->pilots.find("a")->sums->look() != nullptr;
  }

  reports::Test finding(const std::string& lines) const {
    return run({suite(lines)}, {}, silence).suites[0].tests[0];
  }

  StreamedPictures taken() const {
    const Suite read = suite();
    const auto estimators = prepare_all(read);
    const Question question = ask(read.tests[0], estimators, 1);
    return stream_pictures(question, silence);
  }

  tests::Philox random_{3};
};

constexpr const char* kept_whole = "    secondaries: 32\n";

TEST_F(PictureStream, AnswersAClaimOnAllPicturesOfTwoStacksThatNoOtherAsksOf) {
  EXPECT_TRUE(streams(""));
  EXPECT_FALSE(streams(kept_whole));
  EXPECT_FALSE(streams("    detect: 5%\n"));
  EXPECT_FALSE(streams("  - claim: mean(a.average) < 2\n"));
}

TEST_F(PictureStream, GivesTheNumbersOfTheWhole) {
  const reports::Test rows = finding("");
  ASSERT_TRUE(rows.image);
  EXPECT_EQ(rows.verdict, Verdict::pass) << rows.message;
  expect_same_findings(rows, finding(kept_whole));
}

// A window in the middle has it.
TEST_F(PictureStream, SaysWhichNumberOnlyTheWholeCanBeTestedOn) {
  EXPECT_EQ(taken().fault, "");
  EXPECT_NE(taken().pilots.find("a"), nullptr);
  draws::Picture picture = noise();
  picture.values[3 * (70 * width + 11) + 1] = std::numeric_limits<float>::quiet_NaN();
  write('b', 7, picture);
  EXPECT_TRUE(taken().pilots.empty());
  EXPECT_THAT(taken().fault, HasSubstr("b07.exr` is not finite at pixel x 11, y 70 of G"));
  EXPECT_EQ(finding("").verdict, Verdict::error);
}

}  // namespace
}  // namespace assay::harness
