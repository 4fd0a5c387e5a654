// `assay images`: what it makes of its options.

#include <png.h>

#include "harness/command/commands.h"
#include "harness/command/program.h"
#include "harness/suite/suite.h"
#include "tests/harness/pictures.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

float noisy(int, int, const std::string&, double noise) {
  return static_cast<float>(0.3 + 0.05 * noise);
}

ImagesArguments arguments(const Workplace& place) {
  return {.candidate = place.file("a*.exr"), .reference = place.file("b*.exr")};
}

std::string refused(const ImagesArguments& given) {
  return refusal([&] { suite_of_images(given); });
}

using SuiteImages = Placed;

TEST_F(SuiteImages, OnePictureIsExactOrHasTheErrorThatItsChannelsTell) {
  write_stack(place, "a", {.channels = {"Y"}}, noisy);
  ImagesArguments given = arguments(place);
  given.reference = place.file("ref00.exr");
  const auto parameters = [&] {
    return suite_of_images(given).estimators[1].parameters.canonical();
  };
  write_stack(place, "ref", {.channels = {"Y"}, .count = 1}, flat(3));
  EXPECT_THAT(parameters(), HasSubstr("exact"));
  write_stack(place, "ref", {.channels = {"Y", "Variance.Y"}, .count = 1}, flat(3));
  given.channels = "Y";
  EXPECT_THAT(refused(given), HasSubstr("give --samples"));
  given.samples = "100";
  EXPECT_THAT(parameters(), HasSubstr("Variance.*"));
}

TEST_F(SuiteImages, AMarginMakesAProof) {
  write_pair(place, {}, noisy);
  ImagesArguments given = arguments(place);
  EXPECT_EQ(suite_of_images(given).tests[0].claim.text, "mean(candidate) == mean(reference)");
  given.within = "50%";
  EXPECT_EQ(suite_of_images(given).tests[0].claim.text,
            "mean(candidate) within 50% of mean(reference)");
  given.keys["detect"] = "1%";
  EXPECT_THAT(refused(given), HasSubstr("`within` already says which error"));
}

TEST_F(SuiteImages, AMaskThatDoesNotOpenIsNamed) {
  write_pair(place, {}, noisy);
  ImagesArguments given = arguments(place);
  given.mask = "none.png";
  EXPECT_THAT(thrown<InputError>([&] { suite_of_images(given); }),
              HasSubstr("--mask none.png: `none.png`: it does not open"));
}

TEST_F(SuiteImages, WhatCannotBeTestedIsRefusedWithTheMend) {
  write_stack(place, "a", {.count = 15}, noisy);
  ImagesArguments given = arguments(place);
  EXPECT_THAT(refused(given), HasSubstr("15 pictures match, and the test needs 16 or more"));
  write_stack(place, "a", {.count = 16}, noisy);
  EXPECT_THAT(refused(given), HasSubstr("no file matches"));
  write_stack(place, "b", {.count = 2}, noisy);
  EXPECT_THAT(refused(given), HasSubstr("2 pictures match"));
  given.samples = "4";
  EXPECT_THAT(refused(given), HasSubstr("is for a single reference"));
}

TEST_F(SuiteImages, TheCommandLineSaysHowToRunItAgain) {
  const Command command =
      parse_command_line({"images", "--candidate", "a*.exr", "--reference", "r.exr", "--channels",
                          "L.Debug Sample Count.X", "--pixels", "independent", "--alpha", "0.05"});
  const auto& images = std::get<ImagesCommand>(command);
  EXPECT_TRUE(images.arguments.independent_pixels);
  EXPECT_EQ(images.options.alpha, 0.05);
  EXPECT_EQ(images.options.command,
            "assay images --candidate 'a*.exr' --reference r.exr --channels 'L.Debug Sample "
            "Count.X' --pixels independent --alpha 0.05");
}

// Pictures of 6 x 5 pixels as renderers write them, each through the command line. Equal ones are
// of one law, so that each of these has a false alarm of 0.01, whatever the seed.

constexpr float infinity = std::numeric_limits<float>::infinity();

void write_pfm(const std::string& file, const draws::Picture& picture) {
  std::ofstream out(file, std::ios::binary);
  out << "PF\n" << picture.width << ' ' << picture.height << "\n-1.0\n";
  const auto row = static_cast<std::size_t>(3 * picture.width);
  for (int y = picture.height - 1; y >= 0; --y) {
    out.write(
        reinterpret_cast<const char*>(picture.values.data() + static_cast<std::size_t>(y) * row),
        static_cast<std::streamsize>(4 * row));
  }
}

void write_png(const std::string& file, const draws::Picture& picture) {
  std::vector<std::uint8_t> bytes;
  for (const float value : picture.values) {
    const double clipped = std::clamp(double{value}, 0., 1.);
    const double code =
        clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * std::pow(clipped, 1 / 2.4) - 0.055;
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * code)));
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  ASSERT_NE(png_image_write_to_file(&image, file.c_str(), 0, bytes.data(), 0, nullptr), 0);
}

std::vector<reports::Test> answers(const Workplace& place,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"images",         "--candidate", place.file("a*"), "--reference",
                                place.file("b*"), "--pixels",    "independent"};
  line.insert(line.end(), more.begin(), more.end());
  const Command command = parse_command_line(line);
  const Suite suite = suite_of_images(std::get<ImagesCommand>(command).arguments);
  return run({suite}, {.threads = 1}, silence).suites[0].tests;
}

reports::Test answer(const Workplace& place, const std::vector<std::string>& more = {}) {
  const std::vector<reports::Test> tests = answers(place, more);
  EXPECT_EQ(tests.size(), 1u);
  return tests.at(0);
}

using PictureFiles = Placed;

// A background without noise, and renders of the same seeds: rounding alone tells them apart.
TEST_F(PictureFiles, HalvesAgainstFloatsOfTheSameLawPass) {
  const Texel half_constant = [](int x, int, const std::string&, double noise) {
    return x < 3 ? 0.3F : static_cast<float>(0.3 + 0.05 * noise);
  };
  write_stack(place, "a", {.type = Imf::HALF}, half_constant);
  write_stack(place, "b", {}, half_constant);
  EXPECT_EQ(answer(place).verdict, Verdict::pass);
  write_stack(place, "b", {.seed = 'a'}, half_constant);
  EXPECT_THAT(answer(place).message, HasSubstr("or test their differences with `--paired`"));
  EXPECT_EQ(answer(place, {"--paired"}).verdict, Verdict::pass);
  write_stack(place, "b", {}, [&](int x, int y, const std::string& channel, double noise) {
    return 1.1F * half_constant(x, y, channel, noise);
  });
  EXPECT_EQ(answer(place).verdict, Verdict::fail);
}

// Renders differ in other channels.
TEST_F(PictureFiles, OfALayerWithoutNoiseAreComparedExactly) {
  const auto depth_with = [](float dent) {
    return [=](int x, int y, const std::string& channel, double noise) {
      const float depth = static_cast<float>(5 + x) + (x == 4 && y == 3 ? dent : 0);
      return channel == "Z" ? depth : noisy(x, y, channel, noise);
    };
  };
  const PictureKind kind{.channels = {"B", "G", "R", "Z"}};
  write_pair(place, kind, depth_with(0));
  for (const char* how : {"--means", "--paired", "--law"}) {
    EXPECT_EQ(answer(place, {"--channels", "Z", how}).verdict, Verdict::pass) << how;
  }
  write_stack(place, "b", kind, depth_with(.1F));
  const reports::Test test = answer(place, {"--channels", "Z"});
  expect_said(test, Verdict::fail, {"pixel x 4, y 3", "without noise; if it should vary"});
  EXPECT_EQ(answer(place, {"--channels", "Z", "--paired"}).verdict, Verdict::fail);
  EXPECT_EQ(answer(place, {"--channels", "Z", "--law"}).verdict, Verdict::fail);
}

TEST_F(PictureFiles, AnAlphaThatDiffersIsFound) {
  const PictureKind rgba{.channels = {"A", "B", "G", "R"}};
  const auto with_alpha = [](double alpha, double spread) {
    return [=](int x, int y, const std::string& channel, double noise) {
      return channel == "A" ? static_cast<float>(alpha + spread * noise)
                            : noisy(x, y, channel, noise);
    };
  };
  write_pair(place, rgba, with_alpha(0.5, 0.1));
  EXPECT_EQ(answer(place).verdict, Verdict::pass);
  write_stack(place, "b", rgba, with_alpha(0.7, 0.1));
  const reports::Test differs = answer(place);
  EXPECT_EQ(differs.verdict, Verdict::fail);
  EXPECT_EQ(differs.image->winner.component, "A");
  EXPECT_EQ(answer(place, {"--channels", "R,G,B"}).verdict, Verdict::pass);
  // An alpha of 1 tells nothing and is left aside.
  write_pair(place, rgba, with_alpha(1, 0));
  const reports::Test opaque = answer(place);
  EXPECT_EQ(opaque.verdict, Verdict::pass);
  EXPECT_EQ(opaque.image->components, (std::vector<std::string>{"R", "G", "B"}));
  // So does a missing one, which is refused beside one that tells something.
  write_stack(place, "b", {.channels = {"B", "G", "R"}}, noisy);
  EXPECT_EQ(answer(place).verdict, Verdict::pass);
  write_stack(place, "a", rgba, with_alpha(0.5, 0.1));
  EXPECT_THAT(tests::thrown([&] { answer(place); }),
              testing::HasSubstr("its pictures have no alpha, and the other side's alpha is not 1 "
                                 "everywhere; --channels 'R,G,B' compares without it"));
  EXPECT_EQ(answer(place, {"--channels", "R,G,B"}).verdict, Verdict::pass);
}

TEST_F(PictureFiles, InfiniteDepthOnBothSidesIsEqualAndOnOneAFinding) {
  const PictureKind depth{.channels = {"Z"}};
  const auto background_from = [](int column) {
    return [=](int x, int, const std::string&, double noise) {
      return x >= column ? infinity : static_cast<float>(5 + 0.1 * noise);
    };
  };
  write_pair(place, depth, background_from(4));
  EXPECT_EQ(answer(place).verdict, Verdict::pass);
  write_stack(place, "b", depth, background_from(5));
  const reports::Test differs = answer(place);
  EXPECT_EQ(differs.verdict, Verdict::fail) << differs.message;
  EXPECT_EQ(differs.image->winner.x, 4u) << differs.message;
}

TEST_F(PictureFiles, CropsAreComparedWhereBothHavePixelsInColumnsOfTheWhole) {
  const auto spot_of = [](float more) {
    return [=](int x, int y, const std::string& channel, double noise) {
      return noisy(x, y, channel, noise) + (x == 4 && y == 3 ? more : 0);
    };
  };
  write_stack(place, "a", {.left = 2, .top = 1}, spot_of(1));
  write_stack(place, "b", {}, spot_of(0));
  const reports::Test found = answer(place);
  expect_said(found, Verdict::fail, {"pixel x 4, y 3"});
  EXPECT_EQ(found.image->width, 4u);
  write_stack(place, "b", {}, spot_of(1));
  EXPECT_EQ(answer(place).verdict, Verdict::pass);
  write_stack(place, "b", {.right = 5}, spot_of(1));
  EXPECT_THAT(refusal([&] { answer(place); }),
              HasSubstr("render the same part on both, at one size"));
}

TEST_F(PictureFiles, PfmAndPngAreHeldAgainstOpenExr) {
  for (const std::string ending : {"pfm", "png"}) {
    const Workplace folder;
    const auto ramp = [](float factor) {
      return [=](int x, int y, const std::string& channel, double noise) {
        return factor * (noisy(x, y, channel, noise) + 0.02F * static_cast<float>(x + 2 * y));
      };
    };
    write_stack(folder, "a", {}, ramp(1), ending, ending == "pfm" ? write_pfm : write_png);
    write_stack(folder, "b", {}, ramp(1));
    EXPECT_EQ(answer(folder).verdict, Verdict::pass) << ending;
    write_stack(folder, "b", {}, ramp(1.1F));
    const reports::Test differs = answer(folder);
    EXPECT_EQ(differs.verdict, Verdict::fail) << ending;
    EXPECT_NEAR(differs.samples[0].mean.value(), 0.3 + 0.02 * (2.5 + 4), 0.01) << ending;
  }
}

TEST_F(PictureFiles, PixelsThatAreNoNumberOrMaskedAreLeftOut) {
  const auto broken = [](float corner) {
    return [=](int x, int y, const std::string& channel, double noise) {
      const float value = noisy(x, y, channel, noise);
      return x == 1 && y == 2 ? corner : value;
    };
  };
  write_stack(place, "a", {}, broken(std::nanf("")));
  write_stack(place, "b", {}, noisy);
  EXPECT_EQ(answer(place).verdict, Verdict::error);
  EXPECT_EQ(answer(place, {"--ignore", "nonfinite"}).verdict, Verdict::pass);
  write_stack(place, "a", {}, broken(9));
  EXPECT_EQ(answer(place).verdict, Verdict::fail);
  write_stack(place, "mask", {.count = 1}, [](int x, int y, const std::string&, double) {
    return x == 1 && y == 2 ? 0.F : 1.F;
  });
  EXPECT_EQ(answer(place, {"--mask", place.file("mask00.exr")}).verdict, Verdict::pass);
}

TEST_F(PictureFiles, EachLayerHasAClaimOfItsOwn) {
  const PictureKind layered{.channels = {"B", "G", "R", "direct.B", "direct.G", "direct.R"}};
  write_stack(place, "a", layered, noisy);
  write_stack(place, "b", layered, [](int x, int y, const std::string& channel, double noise) {
    return noisy(x, y, channel, noise) + (channel == "direct.G" ? 0.1F : 0);
  });
  const std::vector<reports::Test> tests = answers(place, {"--channels", "*"});
  ASSERT_EQ(tests.size(), 2u);
  EXPECT_EQ(tests[0].claim, "mean(candidate_picture) == mean(reference_picture)");
  EXPECT_EQ(tests[0].verdict, Verdict::pass);
  EXPECT_EQ(tests[1].claim, "mean(candidate_direct) == mean(reference_direct)");
  EXPECT_EQ(tests[1].verdict, Verdict::fail);
  EXPECT_EQ(answer(place).verdict, Verdict::pass);  // R, G and B alone
}

}  // namespace
}  // namespace assay::harness
