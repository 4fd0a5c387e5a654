#include "estimators/parameters.h"

#include "tests/prelude.h"

namespace assay {
namespace {

const std::vector<ParameterInformation> known_parameters = {
    {.name = "radius",
     .summary = "of the disc",
     .range = {.low = 0, .high = 10, .low_excluded = true}},
    {.name = "steps",
     .type = ParameterType::count,
     .summary = "how many",
     .fallback = "16",
     .range = {.low = 1}},
    {.name = "exact", .type = ParameterType::boolean, .summary = "", .fallback = "true"},
    {.name = "mode",
     .type = ParameterType::string,
     .summary = "",
     .fallback = "fast",
     .choices = {"fast", "slow"}},
    {.name = "shape", .type = ParameterType::structure, .summary = "", .fallback = "[1, 2]"},
};

Value scalar(const char* text, int line = 1) {
  return Value::scalar(text, {"suite.yaml", line, 3});
}

Parameters parameters(std::vector<Value::Member> given) {
  return {"family/plugin", known_parameters, Value::map(std::move(given), {"suite.yaml", 1, 1}),
          "/suites"};
}

std::string refusal(std::vector<Value::Member> given) {
  return thrown<InputError>([&] { parameters(std::move(given)); });
}

TEST(Parameters, GivenValuesAndFallbacksAreRead) {
  Parameters p = parameters({{"radius", scalar("2.5")}, {"mode", scalar("slow")}});
  EXPECT_EQ(p.number("radius"), 2.5);
  EXPECT_EQ(p.count("steps"), 16u);
  EXPECT_TRUE(p.boolean("exact"));
  EXPECT_EQ(p.string("mode"), "slow");
  EXPECT_EQ(p.choice<std::size_t>("mode"), 1u);
  EXPECT_EQ(p.structure("shape").items().size(), 2u);
  EXPECT_TRUE(p.given("radius"));
  EXPECT_FALSE(p.given("steps"));
  EXPECT_NO_THROW(p.require_all_read());
}

TEST(Parameters, AnUnknownNameIsRefusedWithTheNearest) {
  EXPECT_THAT(refusal({{"radius", scalar("1")}, {"radus", scalar("1", 7)}}),
              testing::AllOf(StartsWith("suite.yaml:7:3: family/plugin has no parameter `radus`"),
                             HasSubstr("did you mean `radius`?")));
  EXPECT_THAT(refusal({{"radius", scalar("1")}, {"turbidity", scalar("1")}}),
              HasSubstr("it has: radius, steps, exact, mode, shape"));
}

TEST(Parameters, AMissingRequiredOneIsRefused) {
  EXPECT_THAT(refusal({}), testing::AllOf(StartsWith("suite.yaml:1:1: family/plugin"),
                                          HasSubstr("needs the parameter `radius`")));
}

TEST(Parameters, WrongTypesAreRefusedAtTheirPlace) {
  EXPECT_THAT(refusal({{"radius", scalar("wide", 4)}}),
              StartsWith("suite.yaml:4:3: family/plugin: parameter `radius` must be a number"));
  EXPECT_THAT(refusal({{"radius", scalar("1")}, {"steps", scalar("1.5")}}), HasSubstr("`steps`"));
  EXPECT_THAT(refusal({{"radius", scalar("1")}, {"exact", scalar("yes")}}), HasSubstr("`exact`"));
  EXPECT_THAT(refusal({{"radius", scalar("1")}, {"mode", Value::list({})}}), HasSubstr("`mode`"));
}

TEST(Parameters, ValuesOutOfRangeAreRefused) {
  for (const char* text : {"0", "-1", "10.1", "nan", "inf"}) {
    EXPECT_THAT(refusal({{"radius", scalar(text)}}), HasSubstr("must be above 0 and at most 10"))
        << text;
  }
  EXPECT_EQ(refusal({{"radius", scalar("10")}}), thrown([] {}));
  EXPECT_THAT(refusal({{"radius", scalar("1")}, {"steps", scalar("0")}}),
              HasSubstr("must be at least 1"));
  EXPECT_THAT(refusal({{"radius", scalar("1")}, {"mode", scalar("fst")}}),
              HasSubstr("must be one of fast, slow, but it is `fst`; did you mean `fast`?"));
}

TEST(Parameters, SomethingElseThanAMapIsRefused) {
  EXPECT_THROW(Parameters("a/b", known_parameters, Value::list({}), ""), InputError);
}

TEST(Parameters, AnUnreadParameterIsTheAuthorsMistake) {
  Parameters p = parameters({{"radius", scalar("1")}});
  p.number("radius");
  EXPECT_THROW(p.require_all_read(), std::logic_error);
  EXPECT_THROW(p.number("diameter"), std::logic_error);
}

TEST(Parameters, CanonicalTextIsThatOfTheValuesNotOfTheSpelling) {
  const auto canonical = [](const char* radius) {
    return parameters({{"radius", scalar(radius)}}).canonical();
  };
  EXPECT_EQ(canonical("1"), canonical("1.0"));
  EXPECT_NE(canonical("1"), canonical("2"));
  EXPECT_EQ(parameters({{"radius", scalar("1")}, {"steps", scalar("16")}}).canonical(),
            canonical("1"));
  EXPECT_EQ(parameters({{"radius", scalar("1")}}).canonical({"radius"}), "radius=1");
}

TEST(Parameters, FilesAreRelativeToTheFolder) {
  const std::vector<ParameterInformation> file = {
      {.name = "file", .type = ParameterType::string, .summary = ""}};
  const auto resolved = [&](const char* text, const char* folder) {
    return Parameters("a/b", file, Value::map({{"file", scalar(text)}}), folder).file("file");
  };
  EXPECT_EQ(resolved("x/../a.obj", "/suites"), "/suites/a.obj");
  EXPECT_EQ(resolved("/a.obj", "/suites"), "/a.obj");
  EXPECT_EQ(resolved("a.obj", ""), "a.obj");
}

TEST(Parameters, RefuseNamesPluginParameterAndPlace) {
  const Parameters p = parameters({{"radius", scalar("1", 9)}});
  EXPECT_EQ(thrown<InputError>([&] { p.refuse("radius", "is too small for the scene"); }),
            "suite.yaml:9:3: family/plugin: parameter `radius` is too small for the scene");
}

}  // namespace
}  // namespace assay
