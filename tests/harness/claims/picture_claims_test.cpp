// Claims about pictures that another program rendered, from files to verdict.

#include "harness/command/commands.h"
#include "reports/report_formats.h"
#include "tests/harness/pictures.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

constexpr int width = 16;
constexpr int height = 12;

/// Pictures of R, G, B with mean 1 + x / 16 and a normal error of a tenth of it. In `block` of
/// them, 8 x 8 pixels are brighter by a tenth.
void write(const Workplace& place, const std::string& name, int count = 24, bool block = false) {
  write_stack(place, name, {.width = width, .height = height, .count = count},
              [=](int x, int y, const std::string&, double noise) {
                const bool brighter = block && x >= 4 && x < 12 && y >= 4;
                const double mean = (1 + x / 16.0) * (brighter ? 1.1 : 1);
                return static_cast<float>(mean * (1 + 0.1 * noise));
              });
}

/// A picture that is 1 but for one number.
void write_spoilt(const std::string& file, int x, int y, float number) {
  draws::Picture picture{width, height, {"R", "G", "B"}, std::vector<float>(3 * width * height, 1)};
  picture.values[static_cast<std::size_t>(3 * (y * width + x) + 1)] = number;
  draws::write_exr(file, picture);
}

std::string suite_text(const std::string& reference, const std::string& claim) {
  return "suite: s\nestimators:\n  a: {plugin: recorded, file: 'a*.exr', pixels: independent}\n"
         "  b: {plugin: recorded, " +
         reference + "}\ntests:\n  - claim: " + claim + "\n";
}

const std::string stack_b = "file: 'b*.exr', pixels: independent";

class PictureClaims : public Placed {
 protected:
  void write_both() const {
    for (const char* name : {"a", "b"}) write(place, name);
  }
  reports::Test tested(const std::string& claim = "mean(a) == mean(b)",
                       const std::string& reference = stack_b) const {
    return run_in(place, suite_text(reference, claim)).tests[0];
  }
  std::string refused(const std::string& claim, const std::string& reference = stack_b) const {
    return refusal([&] { tested(claim, reference); });
  }
};

// False alarm 0.01 at seed 1: the files are the same whatever the seed.
TEST_F(PictureClaims, StacksOfOneLawPass) {
  write(place, "a");
  write(place, "b", 32);
  const reports::Test test = tested();
  // A difference of both signs of that root mean square would not.
  expect_said(test, Verdict::pass,
              {"; an error of ", "% all over the image would have been found",
               "% of the image's mean in one square of 16 x 16 pixels would have been found, too; "
               "only means"});
  EXPECT_EQ(test.image->replicates, 32u);
  EXPECT_EQ(test.samples.at(0).secondaries, 24u);
  EXPECT_EQ(test.samples.at(1).secondaries, 32u);
  EXPECT_EQ(test.image->components, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_FALSE(test.maps.empty());
}

TEST_F(PictureClaims, WhoseNoiseAFewBrightSamplesMakeSaySo) {
  for (const char* name : {"a", "b"}) {
    write_stack(place, name, {.width = width, .height = height, .count = 24},
                [&](int, int, const std::string&, double noise) {
                  const bool bright = *name == 'a' && noise > 3;
                  return bright ? 1e4F : static_cast<float>(1 + 0.1 * noise);
                });
  }
  expect_said(tested(), Verdict::pass,
              {"; so much noise may come from a few bright samples: test the"});
}

// Two stacks of 24 exclude about a hundredth of the mean. A hundredth of that takes 10^4 times as
// many. The estimate may lie on either side of it.
TEST_F(PictureClaims, ThatAreUndecidedSayHowManyPicturesWouldDecide) {
  write_both();
  for (const char* claim :
       {"mean(a) == mean(b)\n    detect: 0.01%", "mean(a) within 0.01% of mean(b)",
        "mean(a.average) == mean(b.average)\n    detect: 0.01%"}) {
    const reports::Test test = tested(claim);
    expect_said(test, Verdict::inconclusive, {"; give about "});
    double pictures = 0;
    ASSERT_EQ(
        std::sscanf(test.advice.value().words.c_str(), "give about %lf pictures a side", &pictures),
        1)
        << test.message;
    // The estimate lies beyond the margin of `within`: fewer would refute it.
    const bool proof = test.claim.find("within") != std::string::npos;
    EXPECT_GT(pictures, (proof ? 1 : 1000) * 24) << test.message;
  }
}

// Pixels that may depend on each other: signs of whole pictures are flipped, in as many groups of
// pictures as the side with fewer has.
TEST_F(PictureClaims, StacksOfUnequalNumbersAreComparedWhole) {
  for (const bool block : {false, true}) {
    write(place, "a", 90, block);
    write(place, "b", 28);
    for (const char* claim : {"mean(a) == mean(b)", "mean(b) == mean(a)"}) {
      std::string text = suite_text("file: 'b*.exr'", claim);
      text.replace(text.find(", pixels: independent"), 21, "");
      const reports::Test test = run_in(place, text).tests[0];
      expect_said(test, block ? Verdict::fail : Verdict::pass);
      for (const reports::Sample& sample : test.samples) {
        EXPECT_EQ(sample.secondaries, sample.estimator == "a" ? 90u : 28u);
      }
    }
  }
}

TEST_F(PictureClaims, CopiesOnTheOtherSideAreErrorsWithTheirNames) {
  write_both();
  std::filesystem::copy_file(place.file("a03.exr"), place.file("b23.exr"),
                             std::filesystem::copy_options::overwrite_existing);
  for (const char* claim : {"mean(a) == mean(b)", "mean(a.average) == mean(b.average)"}) {
    expect_said(tested(claim), Verdict::error,
                {"`a` and `b` are not independent samples: `", "a03.exr` and `",
                 "b23.exr` are the same picture"});
  }
  EXPECT_THAT(refused("mean(a) == mean(b)", "file: 'a*.exr', pixels: independent"),
              HasSubstr("a*.exr`; give one side pictures of other seeds"));
  // A copy that no test takes is no matter.
  std::filesystem::rename(place.file("b23.exr"), place.file("b24.exr"));
  expect_said(tested("mean(a) == mean(b)\n    secondaries: 20"), Verdict::pass);
}

TEST_F(PictureClaims, WithATexelThatIsNoNumberSayWhichAndWhere) {
  write_both();
  write_spoilt(place.file("b07.exr"), 1, 1, std::numeric_limits<float>::quiet_NaN());
  expect_said(tested(), Verdict::error,
              {"of `b` at pixel x 1, y 1 of G", "is not finite, the first is `", "b07.exr`"});
}

// The second claim keeps values beside the pictures, the third costs.
const std::string three_claims =
    "mean(a) == mean(b)\n"
    "  - claim: distribution(a.average) == distribution(b.average)\n"
    "  - {claim: efficiency(a.average) > 0.001 * efficiency(b.average), cost: samples}";

TEST_F(PictureClaims, NumbersDoNotDependOnTheOtherClaims) {
  write_both();
  const reports::Test expected = tested();
  const reports::Test test = tested(three_claims);
  EXPECT_EQ(test.channels[0].statistic, expected.channels[0].statistic);
  ASSERT_EQ(test.samples.size(), expected.samples.size());
  for (std::size_t i = 0; i < test.samples.size(); ++i) {
    EXPECT_EQ(test.samples[i].mean, expected.samples[i].mean);
    EXPECT_EQ(test.samples[i].variance, expected.samples[i].variance);
  }
}

TEST_F(PictureClaims, AreReplayedToTheBit) {
  write_both();
  std::string text = suite_text(stack_b, three_claims);
  text.insert(text.find("mean(b)\n") + 7, "\n    secondaries: 20");
  const reports::Record record = run_files({place.write("s.yaml", text)}, repeatable);
  const std::string file = place.write("run.json", reports::json(record));
  for (const reports::Test& test : record.suites[0].tests) {
    const Said said = said_by([&] { return replay({.record = file, .test = test.id}); });
    EXPECT_EQ(said.code, 0) << said.text;
    EXPECT_THAT(said.text, HasSubstr("the same numbers as recorded")) << test.id;
  }
}

// Sixteen pictures, whose pixels have skewness 2, stand against the exact one. Chance makes 10 or
// more of 40 fail with probability 5e-5.
TEST_F(PictureClaims, FewSkewedPicturesAreJudgedInLargeCells) {
  const PictureKind kind{.width = 24, .height = 24, .channels = {"Y"}, .count = 16};
  write_stack(place, "ref", {.width = 24, .height = 24, .channels = {"Y"}, .count = 1}, flat(1));
  for (const char* pixels : {"independent", "dependent"}) {
    tests::Philox random(77);
    int failed = 0;
    for (int i = 0; i < 40; ++i) {
      write_stack(place, "a", kind, [&](int, int, const std::string&, double) {
        return static_cast<float>(-std::log1p(-random.uniform()));
      });
      const std::string text =
          "suite: s\nalpha: 0.05\nestimators:\n"
          "  a: {plugin: recorded, file: 'a*.exr', pixels: " +
          std::string(pixels) +
          "}\n  b: {plugin: recorded, file: ref00.exr, exact: true}\n"
          "tests:\n  - claim: mean(a) == mean(b)\n";
      failed += run_in(place, text).tests[0].verdict == Verdict::fail ? 1 : 0;
    }
    EXPECT_LT(failed, 10) << pixels;
  }
}

// A renderer uses three bits of its seed, and another none.
TEST_F(PictureClaims, PicturesThatAProgramRepeatsAreNamed) {
  write(place, "a", 8);
  write(place, "b", 64);
  const auto rendered = [&](const std::string& command) {
    return run_in(place,
                  "suite: s\nestimators:\n"
                  "  b: {plugin: recorded, file: 'b*.exr', pixels: independent}\n"
                  "  a:\n    plugin: command\n    cache: kept\n    command: [sh, -c, '" +
                      command +
                      "', sh, '{seed}', '{out}']\n"
                      "tests:\n  - {claim: mean(a) == mean(b), secondaries: 32}\n")
        .tests[0];
  };
  expect_said(rendered("cp a0$(($1 % 8)).exr $2"), Verdict::invalid,
              {"are the same at x 0-7, y 0-7, bit for bit"});
  expect_said(rendered("cp a00.exr $2"), Verdict::invalid,
              {"images depend on each other", "give each image a seed of its own"});
}

TEST_F(PictureClaims, ADefectIsFoundWhereItIs) {
  write(place, "a", 24, true);
  write(place, "b");
  const reports::Test test = tested();
  // Means of 24 x 64 values: five standard errors of theirs.
  const std::string words = "; at that place it is ";
  expect_said(test, Verdict::fail, {"x 4-11, y 4-11", words});
  double part = 0, low = 0, high = 0, mean = 0, other = 0;
  const std::string found = test.message.substr(test.message.find(words) + words.size());
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
  // Every component is brighter there.
  double green = 0, blue = 0;
  const std::string& also = test.image->winner.others;
  ASSERT_EQ(std::sscanf(also.c_str(), "G differs by %lf\u00a0%%, B by %lf", &green, &blue), 2)
      << also;
  EXPECT_NEAR(green, 10, 4);
  EXPECT_NEAR(blue, 10, 4);
}

TEST_F(PictureClaims, AReferenceIsHeldAgainstWithItsError) {
  write(place, "a");
  const PictureKind kind{.width = width,
                         .height = height,
                         .channels = {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"},
                         .count = 1};
  // Off by two of its standard errors everywhere: 100 samples of variance mean^2.
  write_stack(place, "ref", kind, [](int x, int, const std::string& channel, double) {
    const float mean = 1 + static_cast<float>(x) / 16;
    return channel.starts_with("Variance") ? mean * mean : 1.2F * mean;
  });
  const auto against = [&](const std::string& how) {
    return tested("mean(a) == mean(b)", "file: ref00.exr" + how);
  };
  expect_said(against(", exact: true"), Verdict::fail, {"`b` is one picture, taken as exact"});
  // The variance of one sample hides the difference.
  expect_said(against(", variance: Variance.*, samples: 1"), Verdict::pass);
  const reports::Test test = against(", variance: Variance.*, samples: 1000");
  expect_said(test, Verdict::fail);
  EXPECT_THAT(test.message, Not(HasSubstr("taken as exact")));
}

// Noise of half a standard error of the stack in each pixel of the reference is no pixel's finding.
// The interval of the root mean square excludes 0.
TEST_F(PictureClaims, APassThatItsIntervalDoubtsSaysWhatTheReferenceHides) {
  write(place, "a");
  write_stack(place, "ref", {.width = width, .height = height, .count = 1},
              [](int x, int, const std::string&, double noise) {
                return static_cast<float>((1 + x / 16.0) * (1 + 0.01 * noise));
              });
  const reports::Test test = tested("mean(a) == mean(b)", "file: ref00.exr, exact: true");
  expect_said(test, Verdict::pass, {"`b` is one picture, taken as exact"});
  EXPECT_GT(test.channels[0].effect.low, 0);
}

// Weights that a pixel's own noise chose would make skewed noise look dark.
TEST_F(PictureClaims, TheEffectAtAPlaceOfSkewedNoiseLiesInItsInterval) {
  const auto mean = [](int x) { return std::pow(2.0, x / 16.0); };
  write_stack(place, "ref", {.width = 64, .height = 48, .count = 1},
              [&](int x, int, const std::string&, double) { return static_cast<float>(mean(x)); });
  write_stack(place, "a", {.width = 64, .height = 48, .count = 32},
              [&](int x, int, const std::string&, double noise) {
                return static_cast<float>(1.1 * mean(x) * noise * noise);
              });
  const reports::Test test = tested("mean(a) == mean(b)", "file: ref00.exr, exact: true");
  const reports::Effect& effect = *test.image->winner.effect;
  EXPECT_THAT(*effect.estimate, AllOf(Gt(*effect.low), Lt(*effect.high)));
  EXPECT_THAT(0.1, AllOf(Gt(*effect.low), Lt(*effect.high)));
}

TEST_F(PictureClaims, ADamagedFileIsAnErrorWithItsName) {
  write_both();
  const std::string file = place.file("b11.exr");
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 40);
  expect_said(tested(), Verdict::error, {"`b`: ", file, "damaged or cut short"});
}

TEST_F(PictureClaims, AReferenceStandsOnTheRightOfAMeanAlone) {
  write(place, "a");
  const std::string exact = "file: a00.exr, exact: true";
  EXPECT_THAT(refused("mean(b) == mean(a)", exact), HasSubstr("`b` is a reference"));
  EXPECT_THAT(refused("total_variance(a) <= total_variance(b)", exact),
              HasSubstr("is a reference"));
  EXPECT_THAT(refused("mean(a.R) == mean(b)", exact), HasSubstr("only equal sizes"));
}

}  // namespace
}  // namespace assay::harness
