// Claims about images that share their random numbers, and about the laws of images.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimators/exr.h"
#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

using reports::Verdict;
using ::testing::HasSubstr;

constexpr int width = 24;
constexpr int height = 16;
constexpr int pictures = 32;

// Pictures of heavy noise, and beside each the same one with a share more light in some columns.
struct Pairs {
  double share = 0;
  const char* second_name = "b";
  bool own_seeds = false;
};

void write_pairs(const Workplace& place, const Pairs& pairs) {
  for (int i = 0; i < pictures; ++i) {
    tests::Philox random(static_cast<std::uint32_t>(500 + i));
    draws::Picture first{width, height, {"R", "G", "B"}, {}};
    draws::Picture second = first;
    for (int texel = 0; texel < width * height * 3; ++texel) {
      const bool brighter = texel / 3 % width < 8;
      const double value = std::pow(random.uniform(), -.6);
      const double other = pairs.own_seeds ? std::pow(random.uniform(), -.6) : value;
      first.values.push_back(static_cast<float>(value));
      second.values.push_back(static_cast<float>(other * (brighter ? 1 + pairs.share : 1)));
    }
    draws::write_exr(place.file(fmt::format("a{:02}.exr", i)), first);
    draws::write_exr(place.file(fmt::format("{}{:02}.exr", pairs.second_name, i)), second);
  }
}

reports::Test of_files(const Workplace& place, const std::string& lines) {
  const std::string text =
      "suite: s\nestimators:\n  a: {plugin: recorded, file: 'a*.exr'}\n"
      "  b: {plugin: recorded, file: '" +
      std::string("[b-z]*.exr'}\ntests:\n  - ") + lines + "\n";
  return run_files({place.write("s.yaml", text)}).suites[0].tests[0];
}

constexpr const char* paired = "{claim: mean(b) == mean(a), paired: true}";

TEST(ImagePairs, ShowADifferenceThatNoiseHides) {
  const Workplace place;
  write_pairs(place, {.share = 1e-4});
  const reports::Test apart = of_files(place, "{claim: mean(b) == mean(a)}");
  EXPECT_EQ(apart.verdict, Verdict::invalid) << apart.message;
  EXPECT_THAT(apart.message,
              HasSubstr("images of equal number on both sides share random numbers"));
  EXPECT_THAT(apart.message, HasSubstr("b00.exr"));
  EXPECT_EQ(of_files(place, "{claim: mean(b) == mean(a), secondaries: 32}").message, apart.message);
  const reports::Test test = of_files(place, paired);
  EXPECT_EQ(test.verdict, Verdict::fail);
  EXPECT_LT(*test.channels[0].log10_p, -9);
  EXPECT_THAT(test.null_hypothesis, HasSubstr("in pairs of equal random numbers"));
  ASSERT_TRUE(test.image->winner.effect);
  // Eight of 24 columns differ by this share of their mean.
  EXPECT_NEAR(*test.channels[0].effect.estimate, 1e-4 / std::sqrt(3), 2e-6);
}

TEST(ImagePairs, GiveTheNumbersOfTheWholeRowByRow) {
  const Workplace place;
  write_pairs(place, {.share = 1e-4});
  const reports::Test rows = of_files(place, paired);
  const reports::Test whole =
      of_files(place, "{claim: mean(b) == mean(a), paired: true, secondaries: 32}");
  EXPECT_EQ(rows.channels[0].log10_p, whole.channels[0].log10_p);
  EXPECT_EQ(rows.channels[0].effect.low, whole.channels[0].effect.low);
  EXPECT_EQ(rows.detectable, whole.detectable);
  EXPECT_EQ(rows.message, whole.message);
}

TEST(ImagePairs, EqualInEveryBitPass) {
  const Workplace place;
  write_pairs(place, {});
  const reports::Test test = of_files(place, paired);
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_EQ(*test.channels[0].effect.high, 0);
}

TEST(ImagePairs, PassWithoutASeedInCommon) {
  const Workplace place;
  write_pairs(place, {.own_seeds = true});
  EXPECT_EQ(of_files(place, paired).verdict, Verdict::pass);
}

TEST(ImagePairs, AreFoundByNumberAndRefusedWithoutAPartner) {
  const Workplace place;
  write_pairs(place, {.share = 1e-3, .second_name = "new"});
  EXPECT_EQ(of_files(place, paired).verdict, Verdict::fail);
  const auto refused = [&] { return refusal([&] { of_files(place, paired); }); };
  std::filesystem::rename(place.file("new31.exr"), place.file("new32.exr"));
  EXPECT_THAT(refused(), HasSubstr("have neither name nor number in common"));
  std::filesystem::remove(place.file("new32.exr"));
  EXPECT_THAT(refused(), HasSubstr("needs a partner of the same seed"));
}

TEST(ImagePairs, AreOfTwoImages) {
  const auto refused = [](const std::string& test) {
    return refusal([&] {
      run_text(
          "suite: s\nestimators:\n  a: {plugin: luminaire/floor, width: 8, height: 8}\n"
          "  n: {plugin: analytic/normal}\ntests:\n  - {paired: true, " +
          test + "}\n");
    });
  };
  EXPECT_THAT(refused("claim: mean(a) == analytic"), HasSubstr("`paired` takes two estimators"));
  EXPECT_THAT(refused("claim: mean(n) == mean(n)"), HasSubstr("the means of two images alone"));
  EXPECT_THAT(refused("claim: total_variance(a) <= total_variance(a)"),
              HasSubstr("the means of two images alone"));
}

std::string floors(const std::string& tests) {
  return "suite: s\nestimators:\n"
         "  sound: {plugin: path_tracing/image, integrator: light, width: 24, height: 16}\n"
         "  other: {plugin: path_tracing/image, integrator: bsdf, width: 24, height: 16}\n"
         "  broken: {plugin: mutants/paths_light_density, integrator: light, width: 24, "
         "height: 16, amount: 0.002}\n"
         "tests:\n" +
         tests;
}

// The integrators share a seed whatever their plugins are called.
TEST(ImagePairs, OfPluginsDrawTheSameNumbers) {
  const reports::Record record = run_text(floors(
      "  - {claim: mean(broken) == mean(sound), paired: true, secondaries: 32, expect: fail}\n"
      "  - {claim: mean(other) == mean(sound), paired: true, secondaries: 32}\n"
      "  - {claim: mean(broken) == mean(sound), name: apart, secondaries: 32}\n"
      "  - {claim: mean(broken) == mean(sound), name: planned, paired: true, detect: 0.1%, "
      "expect: fail}\n"));
  for (const reports::Test& test : record.suites[0].tests) {
    EXPECT_TRUE(test.ok) << test.name << ": " << test.message;
  }
  const auto& tests = record.suites[0].tests;
  EXPECT_EQ(tests[0].samples[0].primaries, tests[0].samples[1].primaries);
  EXPECT_EQ(tests[1].samples[0].stream, tests[1].samples[1].stream);
}

// ---- Laws

constexpr const char* laws = "{claim: distribution(b) == distribution(a)}";

TEST(ImageLaws, OfOneRendererPassWithHeavyNoise) {
  const Workplace place;
  write_pairs(place, {.own_seeds = true});
  const reports::Test test = of_files(place, laws);
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_EQ(test.method, "permutation");
  EXPECT_FALSE(test.detectable);
}

TEST(ImageLaws, SayWhatDiffersWhere) {
  const Workplace place;
  write_pairs(place, {.share = .2, .own_seeds = true});
  const reports::Test test = of_files(place, laws);
  EXPECT_EQ(test.verdict, Verdict::fail) << test.message;
  EXPECT_NEAR(*test.channels[0].log10_p, -3, 1e-9);
  EXPECT_THAT(test.message, HasSubstr("the values are mostly larger in `b`"));
  EXPECT_THAT(test.message, HasSubstr("columns 0-"));
  EXPECT_EQ(test.image->winner.statistic, "the values are mostly larger");
  EXPECT_FALSE(test.image->winner.effect);
}

TEST(ImageLaws, HaveNoMarginAndAnotherImage) {
  const Workplace place;
  write_pairs(place, {});
  const auto refused = [&](const std::string& lines) {
    return refusal([&] { of_files(place, lines); });
  };
  EXPECT_THAT(refused("{claim: distribution(b) == distribution(a), detect: 0.1}"),
              HasSubstr("no margin has a meaning"));
  EXPECT_THAT(refused("{claim: 'distribution(b) == normal(0, 1)'}"),
              HasSubstr("is compared with that of another image"));
}

}  // namespace
}  // namespace assay::harness
