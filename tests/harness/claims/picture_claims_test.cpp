// Claims about pictures that another program rendered, from files to verdict.

#include <fmt/format.h>

#include "harness/command/commands.h"
#include "harness/record/replay.h"
#include "reports/formats/json.h"
#include "tests/estimators/exr.h"
#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

constexpr int width = 16;
constexpr int height = 12;

// Pictures of R, G, B with mean 1 + x / 16 and a normal error of a tenth of it. In `block` of them,
// 8 x 8 pixels are brighter by a tenth.
struct Stack {
  std::string name;
  std::uint32_t key;
  bool block = false;
  int count = 24;
};

void write_stack(const Workplace& place, const Stack& stack) {
  tests::Philox random(stack.key);
  for (int i = 0; i < stack.count; ++i) {
    draws::Picture picture{width, height, {"R", "G", "B"}, {}};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const bool brighter = stack.block && x >= 4 && x < 12 && y >= 4;
        const double mean = (1 + x / 16.0) * (brighter ? 1.1 : 1);
        for (int c = 0; c < 3; ++c) {
          picture.values.push_back(static_cast<float>(mean * (1 + 0.1 * random.normal())));
        }
      }
    }
    draws::write_exr(place.file(fmt::format("{}{:02}.exr", stack.name, i)), picture);
  }
}

std::string suite_text(const std::string& reference, const std::string& claim) {
  return "suite: s\nestimators:\n  a: {plugin: recorded, file: 'a*.exr', pixels: independent}\n"
         "  b: {plugin: recorded, " +
         reference + "}\ntests:\n  - claim: " + claim + "\n";
}

constexpr const char* stack_b = "file: 'b*.exr', pixels: independent";

using PictureClaims = Placed;

// False alarm 0.01 at seed 1: the files are the same whatever the seed.
TEST_F(PictureClaims, StacksOfOneLawPass) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2, false, 32});
  const auto record = run_files({place.write("s.yaml", suite_text(stack_b, "mean(a) == mean(b)"))});
  const reports::Test& test = record.suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::pass) << test.message;
  EXPECT_EQ(test.image->replicates, 32u);
  EXPECT_EQ(test.samples.at(0).secondaries, 24u);
  EXPECT_EQ(test.samples.at(1).secondaries, 32u);
  // A difference of both signs of that root mean square would not.
  EXPECT_THAT(test.message, HasSubstr("that is the same all over the image would have been found"));
  EXPECT_EQ(test.image->components, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_FALSE(test.maps.empty());
}

// Pixels that may depend on each other: signs of whole pictures are flipped, in as many groups of
// pictures as the side with fewer has.
TEST_F(PictureClaims, StacksOfUnequalNumbersAreComparedWhole) {
  for (const bool block : {false, true}) {
    const Workplace folder;
    write_stack(folder, {"a", 1, block, 90});
    write_stack(folder, {"b", 2, false, 28});
    for (const char* claim : {"mean(a) == mean(b)", "mean(b) == mean(a)"}) {
      std::string text = suite_text("file: 'b*.exr'", claim);
      text.replace(text.find(", pixels: independent"), 21, "");
      const auto record = run_files({folder.write("s.yaml", text)});
      const reports::Test& test = record.suites[0].tests[0];
      EXPECT_EQ(test.verdict, block ? Verdict::fail : Verdict::pass) << test.message;
      for (const reports::Sample& sample : test.samples) {
        EXPECT_EQ(sample.secondaries, sample.estimator == "a" ? 90u : 28u);
      }
    }
  }
}

TEST_F(PictureClaims, CopiesOnTheOtherSideAreRefusedWithTheirNames) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2});
  std::filesystem::copy_file(place.file("a03.exr"), place.file("b23.exr"),
                             std::filesystem::copy_options::overwrite_existing);
  for (const char* claim : {"mean(a) == mean(b)", "mean(a.average) == mean(b.average)"}) {
    const std::string why =
        refusal([&] { run_files({place.write("s.yaml", suite_text(stack_b, claim))}); });
    EXPECT_THAT(why, HasSubstr("`a` and `b` are no independent samples: `"));
    EXPECT_THAT(why, HasSubstr("a03.exr` and `"));
    EXPECT_THAT(why, HasSubstr("b23.exr` are the same picture"));
  }
}

TEST_F(PictureClaims, OnBothSidesAreRefusedInTheirWords) {
  write_stack(place, {"a", 1});
  const std::string same = suite_text("file: 'a*.exr', pixels: independent", "mean(a) == mean(b)");
  EXPECT_THAT(refusal([&] { run_files({place.write("s.yaml", same)}); }),
              HasSubstr("a*.exr`; give one of them pictures of seeds of their own"));
}

TEST_F(PictureClaims, CopiesThatNoTestTakesAreNoMatter) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2, false, 24});
  std::filesystem::copy_file(place.file("a22.exr"), place.file("b24.exr"));
  std::string text = suite_text(stack_b, "mean(a) == mean(b)");
  text.insert(text.size() - 1, "\n    secondaries: 20");
  EXPECT_EQ(run_files({place.write("s.yaml", text)}).suites[0].tests[0].verdict, Verdict::pass);
}

TEST_F(PictureClaims, WithATexelThatIsNoNumberSayWhichAndWhere) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2});
  draws::Picture picture{width, height, {"R", "G", "B"}, {}};
  picture.values.assign(3 * width * height, 1.5F);
  picture.values[3 * width + 4] = std::numeric_limits<float>::quiet_NaN();  // x 1, y 1 of G
  draws::write_exr(place.file("b07.exr"), picture);
  const auto record = run_files({place.write("s.yaml", suite_text(stack_b, "mean(a) == mean(b)"))});
  const reports::Test& test = record.suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::error);
  EXPECT_THAT(test.message, HasSubstr("of `b` at pixel "));
  EXPECT_THAT(test.message, HasSubstr("are not finite, the first is observation 7, `"));
  EXPECT_THAT(test.message, HasSubstr("b07.exr`"));
}

// The second claim keeps values beside the pictures, the third costs.
constexpr const char* three_claims =
    "mean(a) == mean(b)\n"
    "  - claim: distribution(a.average) == distribution(b.average)\n"
    "  - {claim: efficiency(a.average) > 0.001 * efficiency(b.average), cost: samples}";

TEST_F(PictureClaims, NumbersDoNotDependOnTheOtherClaims) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2});
  const std::string alone = place.write("s.yaml", suite_text(stack_b, "mean(a) == mean(b)"));
  const reports::Test expected = run_files({alone}).suites[0].tests[0];
  const std::string together = place.write("s.yaml", suite_text(stack_b, three_claims));
  const auto record = run_files({together});
  ASSERT_EQ(record.suites[0].tests.size(), 3u);
  const reports::Test& test = record.suites[0].tests[0];
  EXPECT_EQ(test.channels[0].statistic, expected.channels[0].statistic);
  ASSERT_EQ(test.samples.size(), expected.samples.size());
  for (std::size_t i = 0; i < test.samples.size(); ++i) {
    EXPECT_EQ(test.samples[i].mean, expected.samples[i].mean);
    EXPECT_EQ(test.samples[i].variance, expected.samples[i].variance);
  }
}

// A replay has no pilot that read all of them.
TEST_F(PictureClaims, AreReplayedToTheBit) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2});
  std::string text = suite_text(stack_b, three_claims);
  text.insert(text.find("mean(b)\n") + 7, "\n    secondaries: 20");
  const reports::Record record = run_files({place.write("s.yaml", text)});
  const std::string file = place.write("run.json", reports::json(record));
  for (const reports::Test& test : record.suites[0].tests) {
    const Said said = said_by([&] { return replay({.record = file, .test = test.id}); });
    EXPECT_EQ(said.code, 0) << said.text;
    EXPECT_THAT(said.text, HasSubstr("the same numbers as recorded")) << test.id;
  }
}

// Without noise all are alike: that is judged, and not refused.
TEST_F(PictureClaims, PicturesOfOneValueAreNoCopiesAndComparedExactly) {
  const auto verdict = [&](float second) {
    for (int i = 0; i < 20; ++i) {
      for (const char* side : {"a", "b"}) {
        const float value = *side == 'a' ? 0.5F : second;
        const draws::Picture grey{
            width, height, {"R", "G", "B"}, std::vector<float>(3 * width * height, value)};
        draws::write_exr(place.file(fmt::format("{}{:02}.exr", side, i)), grey);
      }
    }
    return run_files({place.write("s.yaml", suite_text(stack_b, "mean(a) == mean(b)"))})
        .suites[0]
        .tests[0]
        .verdict;
  };
  EXPECT_EQ(verdict(0.5F), Verdict::pass);
  EXPECT_EQ(verdict(0.75F), Verdict::fail);
}

// Sixteen pictures, whose pixels have skewness 2, stand against the exact one. Chance makes 10 or
// more of 40 fail with probability 5e-5.
void expect_few_skewed_pictures_to_hold(const std::string& pixels) {
  const Workplace place;
  tests::Philox random(77);
  const std::size_t size = 24;
  draws::write_exr(place.file("ref.exr"), {size, size, {"Y"}, std::vector<float>(size * size, 1)});
  const std::string suite = place.write(
      "s.yaml",
      "suite: s\nalpha: 0.05\nestimators:\n  a: {plugin: recorded, file: 'a*.exr', pixels: " +
          pixels +
          "}\n  b: {plugin: recorded, file: ref.exr, exact: true}\n"
          "tests:\n  - claim: mean(a) == mean(b)\n");
  int failed = 0;
  for (int i = 0; i < 40; ++i) {
    for (int r = 0; r < 16; ++r) {
      draws::Picture picture{size, size, {"Y"}, std::vector<float>(size * size)};
      for (float& value : picture.values) {
        value = static_cast<float>(-std::log1p(-random.uniform()));
      }
      draws::write_exr(place.file(fmt::format("a{:02}.exr", r)), picture);
    }
    failed += run_files({suite}).suites[0].tests[0].verdict == Verdict::fail ? 1 : 0;
  }
  EXPECT_LT(failed, 10);
}

TEST_F(PictureClaims, FewSkewedPicturesAreJudgedInLargeCells) {
  expect_few_skewed_pictures_to_hold("independent");
}

TEST_F(PictureClaims, FewSkewedPicturesOfDependentPixelsAreJudgedInLargeCells) {
  expect_few_skewed_pictures_to_hold("dependent");
}

// A renderer uses three bits of its seed.
TEST_F(PictureClaims, PicturesThatAProgramRepeatsAreNamed) {
  write_stack(place, {"a", 1, false, 8});
  write_stack(place, {"b", 2, false, 64});
  const std::string text =
      "suite: s\nestimators:\n  b: {plugin: recorded, file: 'b*.exr', pixels: independent}\n"
      "  a:\n    plugin: command\n    cache: kept\n"
      "    command: [sh, -c, 'cp a0$(($1 % 8)).exr $2', sh, '{seed}', '{out}']\n"
      "tests:\n  - {claim: mean(a) == mean(b), secondaries: 32}\n";
  const reports::Test test = run_files({place.write("s.yaml", text)}).suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_THAT(test.message, HasSubstr("are the same at x 0-7, y 0-7, bit for bit"));
}

TEST_F(PictureClaims, OfARendererThatIgnoresItsSeedAreNamed) {
  write_stack(place, {"a", 1, false, 1});
  write_stack(place, {"b", 2, false, 64});
  const std::string text =
      "suite: s\nestimators:\n  b: {plugin: recorded, file: 'b*.exr', pixels: independent}\n"
      "  a: {plugin: command, cache: kept, command: [sh, -c, 'cp a00.exr {out}; : {seed}']}\n"
      "tests:\n  - {claim: mean(a) == mean(b), secondaries: 32}\n";
  const reports::Test test = run_files({place.write("s.yaml", text)}).suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::invalid);
  EXPECT_THAT(test.message, HasSubstr("images depend on each other"));
  EXPECT_THAT(test.message, HasSubstr("give each image a seed of its own"));
}

TEST_F(PictureClaims, ADefectIsFoundWhereItIs) {
  write_stack(place, {"a", 1, true});
  write_stack(place, {"b", 2});
  const auto record = run_files({place.write("s.yaml", suite_text(stack_b, "mean(a) == mean(b)"))});
  const reports::Test& test = record.suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::fail) << test.message;
  EXPECT_THAT(test.message, HasSubstr("columns 4-11, rows 4-11"));
  // Means of 24 x 64 values: five standard errors of theirs.
  constexpr const char* words = "; there it is ";
  ASSERT_THAT(test.message, HasSubstr(words));
  double part = 0;
  double low = 0;
  double high = 0;
  double mean = 0;
  double other = 0;
  const std::string found = test.message.substr(test.message.find(words) + std::strlen(words));
  ASSERT_EQ(std::sscanf(found.c_str(), "%lf %% too bright (%lf to %lf %%): %lf against %lf", &part,
                        &low, &high, &mean, &other),
            5)
      << found;
  const double truth = 1 + 7.5 / 16;
  EXPECT_NEAR(mean, 1.1 * truth, 0.1);
  EXPECT_NEAR(other, truth, 0.1);
  EXPECT_NEAR(part, 100 * (mean / other - 1), 0.05);
  EXPECT_LT(low, part);
  EXPECT_GT(high, part);
  EXPECT_NEAR(part, 10, 4);
}

TEST_F(PictureClaims, AReferenceIsHeldAgainstWithItsError) {
  write_stack(place, {"a", 1});
  draws::Picture reference{
      width, height, {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"}, {}};
  for (int i = 0; i < width * height; ++i) {
    const float mean = 1 + static_cast<float>(i % width) / 16;
    // Off by two of its standard errors everywhere: 100 samples of variance mean^2.
    for (int c = 0; c < 3; ++c) reference.values.push_back(1.2F * mean);
    for (int c = 0; c < 3; ++c) reference.values.push_back(mean * mean);
  }
  draws::write_exr(place.file("ref.exr"), reference);
  std::string message;
  const auto verdict = [&](const std::string& how) {
    const auto run =
        run_files({place.write("s.yaml", suite_text("file: ref.exr" + how, "mean(a) == mean(b)"))});
    message = run.suites[0].tests[0].message;
    return run.suites[0].tests[0].verdict;
  };
  EXPECT_EQ(verdict(", exact: true"), Verdict::fail);
  EXPECT_THAT(message, HasSubstr("`b` is one picture, taken as exact"));
  // The variance of one sample hides the difference.
  EXPECT_EQ(verdict(", variance: Variance.*, samples: 1"), Verdict::pass);
  EXPECT_EQ(verdict(", variance: Variance.*, samples: 1000"), Verdict::fail);
  EXPECT_THAT(message, Not(HasSubstr("taken as exact")));
}

TEST_F(PictureClaims, ATexelThatIsNotFiniteIsAnErrorWithItsFileAndPixel) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2});
  draws::Picture bad{width, height, {"R", "G", "B"}, std::vector<float>(3 * width * height, 1)};
  bad.values[3 * (5 * width + 7) + 1] = std::numeric_limits<float>::infinity();
  draws::write_exr(place.file("a07.exr"), bad);
  const auto record = run_files({place.write("s.yaml", suite_text(stack_b, "mean(a) == mean(b)"))});
  const reports::Test& test = record.suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::error);
  EXPECT_THAT(test.message, HasSubstr("at pixel x7y5.G"));
  EXPECT_THAT(test.message, HasSubstr("a07.exr"));
}

TEST_F(PictureClaims, ADamagedFileIsAnErrorWithItsName) {
  write_stack(place, {"a", 1});
  write_stack(place, {"b", 2});
  const std::string file = place.file("b11.exr");
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 40);
  const std::string suite = place.write("s.yaml", suite_text(stack_b, "mean(a) == mean(b)"));
  const reports::Record record = run_files({suite});
  const reports::Test& test = record.suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::error);
  EXPECT_THAT(test.message, HasSubstr("`b` stopped in the pilot: "));
  EXPECT_THAT(test.message, HasSubstr(file));
  EXPECT_THAT(test.message, HasSubstr("damaged or cut short"));
}

TEST_F(PictureClaims, AReferenceStandsOnTheRightOfAMeanAlone) {
  write_stack(place, {"a", 1});
  const auto refused = [&](const std::string& claim) {
    const std::string suite =
        place.write("s.yaml", suite_text("file: a00.exr, exact: true", claim));
    return refusal([&] { run_files({suite}); });
  };
  EXPECT_THAT(refused("mean(b) == mean(a)"), HasSubstr("`b` is a reference"));
  EXPECT_THAT(refused("total_variance(a) <= total_variance(b)"), HasSubstr("is a reference"));
  EXPECT_THAT(refused("mean(a.R) == mean(b)"), HasSubstr("only what is of one size"));
}

}  // namespace
}  // namespace assay::harness
