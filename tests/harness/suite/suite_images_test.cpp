// `assay images`: what it makes of its options.

#include "harness/suite/suite_images.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/command/cli.h"
#include "harness/command/run.h"
#include "tests/estimators/exr.h"
#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

using reports::Verdict;
using ::testing::HasSubstr;

// Pictures of 6 x 5 pixels of one normal law.
void write_pictures(const Workplace& place, const std::string& name, int count) {
  tests::Philox random(static_cast<std::uint32_t>(name[0]));
  for (int i = 0; i < count; ++i) {
    draws::Picture picture{6, 5, {"Y"}, {}};
    for (int k = 0; k < 30; ++k) {
      picture.values.push_back(static_cast<float>(3 + random.normal()));
    }
    draws::write_exr(place.file(fmt::format("{}{:02}.exr", name, i)), picture);
  }
}

void write_reference(const Workplace& place, std::vector<std::string> channels) {
  draws::Picture picture{6, 5, std::move(channels), {}};
  for (std::size_t i = 0; i < 30; ++i) {
    picture.values.push_back(3);
    for (std::size_t c = 1; c < picture.channels.size(); ++c) picture.values.push_back(1);
  }
  draws::write_exr(place.file("ref.exr"), picture);
}

ImagesArguments arguments(const Workplace& place) {
  return {.candidate = place.file("a*.exr"), .reference = place.file("b*.exr")};
}

reports::Test tested(const ImagesArguments& given) {
  Silence silence;
  return run({suite_of_images(given)}, {.threads = 1}, silence).suites[0].tests[0];
}

std::string parameters_of(const Suite& suite) { return suite.estimators[1].parameters.canonical(); }

// False alarm 0.01: the files are the same whatever the seed.
TEST(SuiteImages, TwoStacksAreHeldAgainstEachOther) {
  const Workplace place;
  write_pictures(place, "a", 20);
  write_pictures(place, "b", 24);
  const reports::Test test = tested(arguments(place));
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_EQ(test.claim, "mean(candidate) == mean(reference)");
  ASSERT_TRUE(test.image);
  EXPECT_EQ(test.image->width, 6U);
}

// False alarm 0.01 each.
TEST(SuiteImages, OnePictureIsExactOrHasTheErrorThatItsChannelsTell) {
  const Workplace place;
  write_pictures(place, "a", 20);
  ImagesArguments given = arguments(place);
  given.reference = place.file("ref.exr");
  write_reference(place, {"Y"});
  EXPECT_THAT(parameters_of(suite_of_images(given)), HasSubstr("exact"));
  EXPECT_EQ(tested(given).verdict, Verdict::pass);
  write_reference(place, {"Y", "Variance.Y"});
  given.channels = "Y";
  EXPECT_THAT(refusal([&] { suite_of_images(given); }), HasSubstr("give --samples"));
  given.samples = "100";
  EXPECT_THAT(parameters_of(suite_of_images(given)), HasSubstr("Variance.*"));
  EXPECT_EQ(tested(given).verdict, Verdict::pass);
}

TEST(SuiteImages, AMarginMakesAProof) {
  const Workplace place;
  write_pictures(place, "a", 20);
  write_pictures(place, "b", 20);
  ImagesArguments given = arguments(place);
  given.within = "50%";
  const reports::Test test = tested(given);
  EXPECT_EQ(test.claim, "mean(candidate) within 50% of mean(reference)");
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  given.detect = "1%";
  EXPECT_THAT(refusal([&] { suite_of_images(given); }), HasSubstr("--within says itself"));
}

TEST(SuiteImages, WhatCannotBeTestedIsRefusedWithTheMend) {
  const Workplace place;
  write_pictures(place, "a", 15);
  ImagesArguments given = arguments(place);
  EXPECT_THAT(refusal([&] { suite_of_images(given); }),
              HasSubstr("15 pictures match, and the test takes 16 or more"));
  write_pictures(place, "a", 16);
  EXPECT_THAT(refusal([&] { suite_of_images(given); }), HasSubstr("no file matches"));
  write_pictures(place, "b", 2);
  EXPECT_THAT(refusal([&] { suite_of_images(given); }), HasSubstr("2 pictures match"));
  given.samples = "4";
  EXPECT_THAT(refusal([&] { suite_of_images(given); }), HasSubstr("is of a reference that is one"));
}

TEST(SuiteImages, TheCommandLineSaysHowToRunItAgain) {
  const Command command =
      parse_command_line({"images", "--candidate", "a*.exr", "--reference", "r.exr", "--channels",
                          "L.Debug Sample Count.X", "--pixels", "independent", "--alpha", "0.05"});
  const auto& images = std::get<ImagesCommand>(command);
  EXPECT_TRUE(images.arguments.independent_pixels);
  EXPECT_EQ(images.options.alpha, 0.05);
  EXPECT_EQ(images.options.command,
            "assay images --candidate 'a*.exr' --reference r.exr --channels 'L.Debug Sample "
            "Count.X' --pixels independent --alpha 0.05");
  EXPECT_THAT(refusal([] {
                parse_command_line({"images", "--candidate", "a"});
              }),
              HasSubstr("`assay images` needs --reference"));
}

}  // namespace
}  // namespace assay::harness
