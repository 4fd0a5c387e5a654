// Claims about images that share their random numbers, and about the laws of images.

#include <fmt/format.h>

#include "tests/harness/pictures.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

constexpr int pairs_width = 24;
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
    draws::Picture first{pairs_width, height, {"R", "G", "B"}, {}};
    draws::Picture second = first;
    for (int texel = 0; texel < pairs_width * height * 3; ++texel) {
      const bool brighter = texel / 3 % pairs_width < 8;
      const double value = std::pow(random.uniform(), -.6);
      const double other = pairs.own_seeds ? std::pow(random.uniform(), -.6) : value;
      first.values.push_back(static_cast<float>(value));
      second.values.push_back(static_cast<float>(other * (brighter ? 1 + pairs.share : 1)));
    }
    draws::write_exr(place.file(fmt::format("a{:02}.exr", i)), first);
    draws::write_exr(place.file(fmt::format("{}{:02}.exr", pairs.second_name, i)), second);
  }
}

reports::Test of_files(const Workplace& place, const std::string& lines,
                       const std::string& alpha = "0.01") {
  return run_in(place, "suite: s\nalpha: " + alpha +
                           "\nestimators:\n  a: {plugin: recorded, file: 'a*.exr'}\n"
                           "  b: {plugin: recorded, file: '[b-z]*.exr'}\ntests:\n  - " +
                           lines + "\n")
      .tests[0];
}

constexpr const char* paired = "{claim: mean(b) == mean(a), paired: true}";

using ImagePairs = Placed;

TEST_F(ImagePairs, ShowADifferenceThatNoiseHides) {
  write_pairs(place, {.share = 1e-4});
  const reports::Test apart = of_files(place, "{claim: mean(b) == mean(a)}");
  expect_said(apart, Verdict::invalid,
              {"images of equal number on both sides share random numbers", "b00.exr"});
  EXPECT_EQ(of_files(place, "{claim: mean(b) == mean(a), secondaries: 32}").message, apart.message);
  const reports::Test test = of_files(place, paired);
  EXPECT_EQ(test.verdict, Verdict::fail);
  EXPECT_LT(*test.channels[0].log10_p, -9);
  EXPECT_THAT(test.null_hypothesis, HasSubstr("in pairs of equal random numbers"));
  ASSERT_TRUE(test.image->winner.effect);
  // Eight of 24 columns differ by this share of their mean.
  EXPECT_NEAR(*test.channels[0].effect.estimate, 1e-4 / std::sqrt(3), 2e-6);
}

TEST_F(ImagePairs, GiveTheNumbersOfTheWholeRowByRow) {
  write_pairs(place, {.share = 1e-4});
  const reports::Test rows = of_files(place, paired);
  const reports::Test whole =
      of_files(place, "{claim: mean(b) == mean(a), paired: true, secondaries: 32}");
  EXPECT_EQ(rows.channels[0].log10_p, whole.channels[0].log10_p);
  EXPECT_EQ(rows.channels[0].effect.low, whole.channels[0].effect.low);
  EXPECT_EQ(rows.detectable, whole.detectable);
  EXPECT_EQ(rows.message, whole.message);
}

TEST_F(ImagePairs, PassWithoutASeedInCommon) {
  write_pairs(place, {.own_seeds = true});
  EXPECT_EQ(of_files(place, paired).verdict, Verdict::pass);
}

TEST_F(ImagePairs, AreFoundByNumberAndRefusedWithoutAPartner) {
  write_pairs(place, {.share = 1e-3, .second_name = "new"});
  EXPECT_EQ(of_files(place, paired).verdict, Verdict::fail);
  const auto refused = [&] { return refusal([&] { of_files(place, paired); }); };
  std::filesystem::rename(place.file("new31.exr"), place.file("new32.exr"));
  EXPECT_THAT(refused(), HasSubstr("their names say `32` and `31`; name both pictures"));
  std::filesystem::remove(place.file("new32.exr"));
  EXPECT_THAT(refused(), HasSubstr("needs a partner of the same seed"));
}

std::string floors(const std::string& tests) {
  return "suite: s\nestimators:\n"
         "  sound: {plugin: path_tracing/image, integrator: light, width: 24, height: 16}\n"
         "  other: {plugin: path_tracing/image, integrator: bsdf, width: 24, height: 16}\n"
         "  broken: {plugin: mutants/paths_light_density, integrator: light, width: 24, "
         "height: 16, amount: 0.002}\n"
         "  same: {plugin: mutants/paths_schlick, integrator: light, width: 24, height: 16}\n"
         "tests:\n" +
         tests;
}

// The integrators share a seed whatever their plugins are called.
TEST_F(ImagePairs, OfPluginsDrawTheSameNumbers) {
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

TEST_F(ImagePairs, ThatAreDrawnAlikePass) {
  const reports::Record record = run_text(
      floors("  - {claim: mean(same) == mean(sound), paired: true, secondaries: 16}\n"
             "  - {claim: mean(same) == mean(sound), name: planned, paired: true, detect: 1%}\n"));
  for (const reports::Test& test : record.suites[0].tests) {
    EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
    EXPECT_EQ(*test.channels[0].effect.high, 0);
  }
}

// The first 64 of the name is no seed, and neither is what a side's names have in common.
TEST_F(ImagePairs, AreFoundByWhatTellsTheNamesOfASideApart) {
  write_pairs(place, {.share = 1e-3});
  const auto rename = [&](const char* from, int first, const char* to, int then) {
    for (int i = 0; i < pictures; ++i) {
      std::filesystem::rename(place.file(fmt::format(fmt::runtime(from), first + i)),
                              place.file(fmt::format(fmt::runtime(to), then + i)));
    }
  };
  rename("a{:02}.exr", 0, "a_{}_64spp.exr", 10);
  rename("b{:02}.exr", 0, "b2_{:03}_128spp.exr", 10);
  EXPECT_EQ(of_files(place, paired).verdict, Verdict::fail);
  rename("b2_{:03}_128spp.exr", 10, "b2_{:03}_64spp.exr", 110);
  EXPECT_THAT(refusal([&] { of_files(place, paired); }),
              HasSubstr("their names say `110` and `10`"));
}

/// Pictures 3 and 7 of a side are the same in their first tile.
void repeat_a_tile(const Workplace& place, const char* side) {
  for (const int i : {3, 7}) {
    tests::Philox random(static_cast<std::uint32_t>(900 + i + (side[0] == 'a' ? 50 : 0)));
    tests::Philox common(static_cast<std::uint32_t>(side[0]));
    draws::Picture picture{pairs_width, height, {"R", "G", "B"}, {}};
    for (int texel = 0; texel < pairs_width * height * 3; ++texel) {
      const bool first = texel / 3 % pairs_width < 8 && texel / 3 / pairs_width < 8;
      picture.values.push_back(static_cast<float>((first ? common : random).uniform()));
    }
    draws::write_exr(place.file(fmt::format("{}{:02}.exr", side, i)), picture);
  }
}

TEST_F(ImagePairs, NameDifferencesThatRepeat) {
  write_pairs(place, {.own_seeds = true});
  for (const char* side : {"a", "b"}) repeat_a_tile(place, side);
  const reports::Test test = of_files(place, paired);
  expect_said(test, Verdict::invalid, {"differences depend on each other"});
  EXPECT_THAT(test.message, ContainsRegex("b03.exr` less `.*a03.exr` and `.*b07.exr` less"));
}

// ---- Laws

constexpr const char* laws_claim = "{claim: distribution(b) == distribution(a)}";

using ImageLaws = Placed;

TEST_F(ImageLaws, OfOneRendererPassWithHeavyNoise) {
  write_pairs(place, {.own_seeds = true});
  const reports::Test test = of_files(place, laws_claim);
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_EQ(test.method, "permutation");
  EXPECT_FALSE(test.detectable);
}

TEST_F(ImageLaws, SayWhatDiffersWhere) {
  write_pairs(place, {.share = .2, .own_seeds = true});
  const reports::Test test = of_files(place, laws_claim);
  EXPECT_EQ(test.verdict, Verdict::fail) << test.message;
  EXPECT_NEAR(*test.channels[0].log10_p, -3, 1e-9);
  EXPECT_THAT(test.message, HasSubstr("there the values are mostly larger in b"));
  EXPECT_THAT(test.message, HasSubstr("x 0-"));
  EXPECT_EQ(test.image->winner.statistic, "the values are mostly larger in b");
  EXPECT_FALSE(test.image->winner.effect);
}

TEST_F(ImageLaws, DoNotOfferPairs) {
  write_pairs(place, {.share = 1e-4});
  EXPECT_THAT(of_files(place, laws_claim).message, EndsWith("give one side other seeds"));
}

TEST_F(ImageLaws, TakeAShareOfAlphaThatLabelsCanReach) {
  write_pairs(place, {.own_seeds = true});
  expect_said(of_files(place, laws_claim, "1e-6"), Verdict::invalid,
              {"needs 1e-05 or more, as it draws"});
}

TEST_F(ImageLaws, OfPicturesWithoutNoiseAreOfTheWholeImage) {
  write_pair(place, {.width = pairs_width, .height = height, .count = 16}, flat(1));
  const reports::Test test = of_files(place, laws_claim);
  expect_said(test, Verdict::pass);
  EXPECT_EQ(test.image->winner.width, static_cast<std::uint64_t>(pairs_width));
  EXPECT_FALSE(test.channels[0].effect.estimate);
}

}  // namespace
}  // namespace assay::harness
