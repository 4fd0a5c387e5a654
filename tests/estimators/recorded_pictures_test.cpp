
#include "estimators/core/text_pattern.h"
#include "recorded/picture_setup.h"
#include "tests/estimators/draws.h"
#include "tests/estimators/exr.h"
#include "tests/estimators/exr_kinds.h"
#include "tests/prelude.h"

namespace assay {
namespace {

class Pictures : public InFolder {
 protected:
  recorded::PictureChannels choose(const std::vector<std::string>& channels,
                                   const std::string& patterns = "usual") const {
    draws::write_scan_lines(file("a.exr"), {.channels = channels});
    return recorded::choose_channels(*open_picture(file("a.exr")), patterns);
  }
  // One texel.
  void write_texel(const std::string& name, const std::vector<std::string>& channels,
                   std::vector<float> values) const {
    draws::write_exr(file(name), {1, 1, channels, std::move(values)});
  }
  draws::Prepared prepare(const std::string& parameters) const {
    return draws::prepare("recorded", parameters, folder_.string());
  }
  std::string refusal(const std::string& parameters) const {
    return thrown<InputError>([&] { prepare(parameters); });
  }
};

TEST(Patterns, KnowStarsAndQuestionMarks) {
  EXPECT_TRUE(matches("ViewLayer.*.R", "ViewLayer.Debug Sample Count.R"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("a*b*c", "abbbc"));
  EXPECT_TRUE(matches("?", "R"));
  EXPECT_FALSE(matches("?", ""));
  EXPECT_FALSE(matches("a*b", "abc"));
  EXPECT_FALSE(matches("R", "RR"));
}

TEST_F(Pictures, ChooseWhatARendererShows) {
  EXPECT_THAT(choose({"A", "B", "G", "R"}).names, ElementsAre("R", "G", "B"));
  EXPECT_THAT(choose({"Y", "depth"}).names, ElementsAre("Y"));
  EXPECT_THAT(choose({"z"}).names, ElementsAre("z"));
  const auto blender =
      choose({"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
              "ViewLayer.Combined.A", "ViewLayer.DiffInd.R", "ViewLayer.DiffInd.G",
              "ViewLayer.DiffInd.B", "ViewLayer.Debug Sample Count.X"});
  EXPECT_THAT(blender.names,
              ElementsAre("ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"));
  EXPECT_THAT(blender.components, ElementsAre("R", "G", "B"));
  const auto mitsuba =
      choose({"path.R", "path.G", "path.B", "m2_path.R", "m2_path.G", "m2_path.B"});
  EXPECT_THAT(mitsuba.names, ElementsAre("path.R", "path.G", "path.B"));
  const auto pbrt = choose({"R", "G", "B", "Variance.R", "Variance.G", "Variance.B", "u", "v"});
  EXPECT_THAT(pbrt.names, ElementsAre("R", "G", "B"));
}

TEST_F(Pictures, ChooseByPatternsInTheOrderOfColours) {
  const std::vector<std::string> all{"L.DiffInd.B", "L.DiffInd.G", "L.DiffInd.R", "L.Depth.Z",
                                     "L.Debug Sample Count.X"};
  const auto one = choose(all, "L.DiffInd.*");
  EXPECT_THAT(one.names, ElementsAre("L.DiffInd.R", "L.DiffInd.G", "L.DiffInd.B"));
  EXPECT_THAT(one.components, ElementsAre("R", "G", "B"));
  const auto two = choose(all, "L.Depth.Z, *.R");
  EXPECT_THAT(two.components, ElementsAre("L.Depth.Z", "L.Depth.Z_infinite", "L.DiffInd.R"));
  EXPECT_THAT(choose({"N.X", "N.Y", "N.Z"}, "N.*").components, ElementsAre("X", "Y", "Z"));
  EXPECT_THAT(choose(all, "*Sample Count*").components, ElementsAre("X"));
}

TEST_F(Pictures, RefuseWhereTheChoiceIsNotPlain) {
  EXPECT_THAT(thrown<InputError>([&] {
                choose({"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"});
              }),
              HasSubstr("choose them with `channels`"));
  EXPECT_THAT(thrown<InputError>([&] {
                choose({"R", "G", "B"}, "Q*");
              }),
              HasSubstr("no channel matches `Q*`; it has `B`, `G`, `R`"));
}

TEST_F(Pictures, AreOneObservationEachInTheOrderOfTheirNames) {
  write_texel("b.exr", {"Y"}, {2});
  write_texel("a.exr", {"Y"}, {1});
  write_texel("c.exr", {"Y"}, {std::nanf("")});
  const draws::Prepared pictures = prepare("{file: *.exr}");
  EXPECT_EQ(pictures.setup->observations(), 3u);
  EXPECT_FALSE(pictures.setup->image()->independent);
  EXPECT_EQ(pictures.setup->channels()[0].name, "x0y0");
  EXPECT_EQ(recorded::observation_place(*pictures.setup, {.index = 1}), file("b.exr"));
  const auto observed = draws::observe(pictures, 3);
  EXPECT_EQ(observed[0].values[0], 1);
  EXPECT_EQ(observed[0].values[1], 2);
  EXPECT_TRUE(std::isnan(observed[0].values[2]));
  EXPECT_EQ(observed[1].values[1], 2);  // the average over the picture
  EXPECT_TRUE(pictures.setup->channels()[1].diagnostic);
}

TEST_F(Pictures, ThatAreCopiesAreRefusedByName) {
  write_texel("a.exr", {"R", "G", "B"}, {1, 2, 3});
  write_texel("b.exr", {"R", "G", "B"}, {1, 2, 4});
  write_texel("c.exr", {"R", "G", "B"}, {1, 2, 3});
  const draws::Prepared pictures = prepare("{file: *.exr}");
  draws::observe(pictures, 2);
  draws::observe(pictures, 2);
  EXPECT_EQ(thrown<InputError>([&] {
              draws::observe(pictures, 3);
            }).find(file("c.exr") + ": is the same picture as `" + file("a.exr") + "`"),
            0u);
}

TEST_F(Pictures, OfOneValueThroughoutMayBeEqual) {
  write_texel("a.exr", {"R", "G", "B"}, {0, 0, 0});
  write_texel("b.exr", {"R", "G", "B"}, {0, 0, 0});
  EXPECT_EQ(draws::observe(prepare("{file: *.exr}"), 2)[0].values.size(), 2u);
}

TEST_F(Pictures, OfUnequalSizesAreRefusedByName) {
  draws::write_scan_lines(file("a.exr"), {.width = 4, .channels = {"Y"}});
  draws::write_scan_lines(file("b.exr"), {.width = 5, .channels = {"Y"}});
  EXPECT_THAT(refusal("{file: *.exr}"),
              HasSubstr("is `" + file("b.exr") + "`: it has 5 x 3 pixels, but `" + file("a.exr") +
                        "` has 4 x 3: render all files at one size"));
  draws::write_scan_lines(file("b.exr"), {.width = 4, .channels = {"Y"}, .left = 1});
  EXPECT_THAT(refusal("{file: *.exr}"), HasSubstr("data window lies elsewhere"));
  draws::write_scan_lines(file("b.exr"), {.width = 4, .channels = {"Z"}});
  EXPECT_THAT(refusal("{file: *.exr}"), HasSubstr("there is no channel `Y`"));
}

TEST_F(Pictures, ThatAreNotThereAreRefused) {
  EXPECT_THAT(refusal("{file: x*.exr}"), HasSubstr("no file matches"));
  EXPECT_THAT(refusal("{file: x.exr}"), HasSubstr("there is no such file"));
}

TEST_F(Pictures, WithTheirVarianceAreReferences) {
  draws::write_scan_lines(
      file("a.exr"), {.width = 1, .height = 1, .channels = {"R", "Variance.R"}, .samples = 16});
  const draws::Prepared reference = prepare("{file: a.exr, channels: R, variance: Variance.*}");
  EXPECT_TRUE(recorded::is_reference(*reference.setup));
  const Channel channel = reference.setup->channels()[0];
  EXPECT_EQ(channel.mean, 0.5);
  EXPECT_DOUBLE_EQ(channel.mean_error, std::sqrt(1.5 / 16));
}

// Five pixels in a row; samples have seen only the last vary. With few of them an error of zero
// would make the others exact.
TEST_F(Pictures, OfFewSamplesHaveErrorsNoSmallerThanAroundThem) {
  draws::write_exr(file("a.exr"), {.width = 5,
                                   .height = 1,
                                   .channels = {"R", "Variance.R"},
                                   .values = {1, 0, 1, 0, 1, 0, 1, 0, 1, 8}});
  const auto squared_errors = [&](const std::string& samples) {
    const draws::Prepared reference =
        prepare("{file: a.exr, channels: R, variance: Variance.*, samples: " + samples + "}");
    std::vector<double> squares;
    for (const Channel& channel : reference.setup->channels()) {
      squares.push_back(channel.mean_error * channel.mean_error);
    }
    return squares;
  };
  using testing::DoubleNear;
  using testing::ElementsAre;
  const auto near = [](double value) { return DoubleNear(value, 1e-12); };
  EXPECT_THAT(squared_errors("4"),
              ElementsAre(near(.4), near(.4), near(.4), near(2. / 3), near(2)));
  EXPECT_THAT(squared_errors("200000"), ElementsAre(0, 0, 0, 0, near(4e-5)));
}

TEST_F(Pictures, WithSecondMomentsAreReferencesOfOneSampleLess) {
  write_texel("a.exr", {"path.R", "m2_path.R", "count"}, {3, 13, 5});
  const auto error = [&](const std::string& samples) {
    return prepare("{file: a.exr, channels: path.R, second_moment: m2_*, samples: " + samples + "}")
        .setup->channels()[0]
        .mean_error;
  };
  EXPECT_DOUBLE_EQ(error("17"), std::sqrt((13.0 - 9) / 16));
  EXPECT_DOUBLE_EQ(error("count"), 1);
}

TEST_F(Pictures, MayBeExactReferences) {
  write_texel("a.exr", {"Y"}, {3});
  const draws::Prepared reference = prepare("{file: a.exr, exact: true}");
  EXPECT_TRUE(recorded::is_reference(*reference.setup));
  EXPECT_EQ(reference.setup->channels()[0].mean, 3);
  EXPECT_EQ(reference.setup->channels()[0].mean_error, 0);
}

TEST_F(Pictures, AsReferencesAreRefusedWhereTheyMakeNoSense) {
  write_texel("a.exr", {"Y", "Variance.Y", "m2_Y"}, {3, -1, 12});
  write_texel("b.exr", {"Y"}, {std::nanf("")});
  const std::string y = ", channels: Y";
  EXPECT_THAT(refusal("{file: a.exr, variance: Variance.*" + y + "}"),
              HasSubstr("does not say of how many samples"));
  EXPECT_THAT(refusal("{file: a.exr, samples: 4, variance: Variance.*" + y + "}"),
              HasSubstr("the variance is negative at pixel x 0, y 0 of Y"));
  EXPECT_THAT(refusal("{file: a.exr, samples: 1, second_moment: m2_*" + y + "}"),
              HasSubstr("`samples` must be 2 or more"));
  EXPECT_THAT(refusal("{file: a.exr, samples: 4, variance: V.*" + y + "}"),
              HasSubstr("there is no channel `V.Y`"));
  EXPECT_THAT(refusal("{file: *.exr, exact: true" + y + "}"), HasSubstr("names 2 files"));
  EXPECT_THAT(refusal("{file: b.exr, exact: true}"), HasSubstr("not finite at pixel x 0, y 0"));
  EXPECT_THAT(refusal("{file: a.exr, exact: true, variance: Variance.*, samples: 4" + y + "}"),
              HasSubstr("exact or has an error"));
  EXPECT_THAT(refusal("{file: a.exr, samples: 4" + y + "}"), HasSubstr("needs `variance`"));
  EXPECT_THAT(refusal("{file: a.exr, column: Y}"), HasSubstr("choose `channels`"));
  draws::write_bytes(file("t.txt"), "1\n");
  EXPECT_THAT(refusal("{file: t.txt, channels: R}"), HasSubstr("`file` names none"));
}

}  // namespace
}  // namespace assay
