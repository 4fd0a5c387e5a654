#include "estimators/core/value.h"
#include "estimators/pictures.h"
#include "tests/estimators/exr_kinds.h"
#include "tests/estimators/prelude.h"

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
    return draws::refusal("recorded", parameters, folder_.string());
  }
};

TEST(Patterns, KnowStarsAndQuestionMarks) {
  for (const auto& [pattern, text, matched] :
       {std::tuple{"ViewLayer.*.R", "ViewLayer.Debug Sample Count.R", true},
        {"*", "", true},
        {"a*b*c", "abbbc", true},
        {"?", "R", true},
        {"?", "", false},
        {"a*b", "abc", false},
        {"R", "RR", false}}) {
    EXPECT_EQ(matches(pattern, text), matched) << pattern << " " << text;
  }
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
  const auto refused = [&](const std::vector<std::string>& channels, const char* patterns) {
    return thrown<InputError>([&] { choose(channels, patterns); });
  };
  EXPECT_THAT(refused({"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}, "usual"),
              HasSubstr("choose them with `channels`"));
  EXPECT_THAT(refused({"R", "G", "B"}, "Q*"),
              HasSubstr("no channel matches `Q*`; it has `B`, `G`, `R`"));
}

TEST_F(Pictures, AreOneObservationEachInTheOrderOfTheirNames) {
  write_texel("b.exr", {"Y"}, {2});
  write_texel("a.exr", {"Y"}, {1});
  write_texel("c.exr", {"Y"}, {std::nanf("")});
  const draws::Prepared pictures = prepare("{file: '*.exr'}");
  EXPECT_EQ(pictures.setup->observations(), 3u);
  EXPECT_FALSE(pictures.setup->image()->independent);
  EXPECT_EQ(pictures.channel().name, "x0y0");
  EXPECT_EQ(pictures.setup->place_of({.index = 1}), file("b.exr"));
  const auto observed = draws::observe(pictures, 3);
  EXPECT_EQ(observed[0].values[0], 1);
  EXPECT_EQ(observed[0].values[1], 2);
  EXPECT_TRUE(std::isnan(observed[0].values[2]));
  EXPECT_EQ(observed[1].values[1], 2);  // the average over the picture
  EXPECT_TRUE(pictures.channel(1).diagnostic);
}

TEST_F(Pictures, ThatAreCopiesAreRefusedByName) {
  write_texel("a.exr", {"R", "G", "B"}, {1, 2, 3});
  write_texel("b.exr", {"R", "G", "B"}, {1, 2, 4});
  write_texel("c.exr", {"R", "G", "B"}, {1, 2, 3});
  const draws::Prepared pictures = prepare("{file: '*.exr'}");
  draws::observe(pictures, 2);
  draws::observe(pictures, 2);
  EXPECT_THAT(thrown<InputError>([&] { draws::observe(pictures, 3); }),
              StartsWith("`" + file("c.exr") + "` is the same picture as `" + file("a.exr") + "`"));
  // Pictures of one value throughout may be equal.
  for (const char* name : {"a.exr", "c.exr"}) write_texel(name, {"R", "G", "B"}, {0, 0, 0});
  EXPECT_EQ(draws::observe(prepare("{file: '*.exr'}"), 3)[0].values.size(), 3u);
}

TEST_F(Pictures, OfUnequalSizesAreRefusedByName) {
  draws::write_scan_lines(file("a.exr"), {.width = 4, .channels = {"Y"}});
  draws::write_scan_lines(file("b.exr"), {.width = 5, .channels = {"Y"}});
  EXPECT_THAT(refusal("{file: '*.exr'}"),
              HasSubstr("is `" + file("b.exr") + "`: it has 5 x 3 pixels, but `" + file("a.exr") +
                        "` has 4 x 3: render all files at one size"));
  draws::write_scan_lines(file("b.exr"), {.width = 4, .channels = {"Y"}, .left = 1});
  EXPECT_THAT(refusal("{file: '*.exr'}"), HasSubstr("data window lies elsewhere"));
  draws::write_scan_lines(file("b.exr"), {.width = 4, .channels = {"Z"}});
  EXPECT_THAT(refusal("{file: '*.exr'}"), HasSubstr("there is no channel `Y`"));
}

TEST_F(Pictures, WithTheirVarianceAreReferences) {
  draws::write_scan_lines(
      file("a.exr"), {.width = 1, .height = 1, .channels = {"R", "Variance.R"}, .samples = 16});
  const draws::Prepared reference = prepare("{file: a.exr, channels: R, variance: Variance.*}");
  EXPECT_TRUE(reference.setup->is_reference());
  const Channel channel = reference.channel();
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
  const auto near = [](double value) { return DoubleNear(value, 1e-12); };
  EXPECT_THAT(squared_errors("4"),
              ElementsAre(near(.4), near(.4), near(.4), near(2. / 3), near(2)));
  EXPECT_THAT(squared_errors("200000"), ElementsAre(0, 0, 0, 0, near(4e-5)));
}

TEST_F(Pictures, WithSecondMomentsAreReferencesOfOneSampleLess) {
  write_texel("a.exr", {"path.R", "m2_path.R", "count"}, {3, 13, 5});
  const auto error = [&](const std::string& samples) {
    return prepare("{file: a.exr, channels: path.R, second_moment: m2_*, samples: " + samples + "}")
        .channel()
        .mean_error;
  };
  EXPECT_DOUBLE_EQ(error("17"), std::sqrt((13.0 - 9) / 16));
  EXPECT_DOUBLE_EQ(error("count"), 1);
}

TEST_F(Pictures, MayBeExactReferences) {
  write_texel("a.exr", {"Y"}, {3});
  const draws::Prepared reference = prepare("{file: a.exr, exact: true}");
  EXPECT_TRUE(reference.setup->is_reference());
  EXPECT_EQ(reference.channel().mean, 3);
  EXPECT_EQ(reference.channel().mean_error, 0);
}

TEST_F(Pictures, AreRefusedWhereTheyMakeNoSense) {
  write_texel("a.exr", {"Y", "Variance.Y", "m2_Y"}, {3, -1, 12});
  write_texel("b.exr", {"Y"}, {std::nanf("")});
  draws::write_bytes(file("t.txt"), "1\n");
  for (const auto& [given, said] :
       {std::array{"a.exr, channels: Y, variance: Variance.*", "does not say how many samples"},
        {"a.exr, channels: Y, samples: 4, variance: Variance.*",
         "the variance is negative at pixel x 0, y 0 of Y"},
        {"a.exr, channels: Y, samples: 1, second_moment: m2_*", "`samples` must be 2 or more"},
        {"a.exr, channels: Y, samples: 4, variance: V.*", "there is no channel `V.Y`"},
        {"'*.exr', channels: Y, exact: true", "names 2 files"},
        {"b.exr, exact: true", "not finite at pixel x 0, y 0"},
        {"a.exr, channels: Y, exact: true, variance: Variance.*, samples: 4",
         "exact or has an error"},
        {"a.exr, channels: Y, samples: 4", "needs `variance`"},
        {"a.exr, column: Y", "use `channels`"},
        {"t.txt, channels: R", "`file` names none"},
        {"x*.exr", "no file matches"},
        {"x.exr", "there is no such file"}}) {
    EXPECT_THAT(refusal(std::string("{file: ") + given + "}"), HasSubstr(said)) << given;
  }
}

}  // namespace
}  // namespace assay
