#include "estimators/core/value.h"

#include "tests/prelude.h"

namespace assay {
namespace {

double number(const char* text) { return Value::scalar(text).number("x"); }

TEST(Value, NumbersAreReadAsWritten) {
  EXPECT_EQ(number("1000"), 1000);
  EXPECT_EQ(number("1e3"), 1000);
  EXPECT_EQ(number(".5"), 0.5);
  EXPECT_EQ(number("-.5e-2"), -0.005);
  EXPECT_EQ(number("+2"), 2);
  EXPECT_TRUE(std::isinf(number("inf")));
}

TEST(Value, TextThatIsNotANumberIsRefusedAtItsPlace) {
  for (const char* text :
       {"", "1x", "0x10", "++1", "+-1", "1 2", "5%", "1,000", "one", "1e999", ".", "- 1"}) {
    EXPECT_THAT(thrown<InputError>([&] {
                  Value::scalar(text, {"suite.yaml", 3, 7}).number("parameter `radius`");
                }),
                AllOf(StartsWith("suite.yaml:3:7: parameter `radius`"),
                      HasSubstr("`" + std::string(text) + "`")));
  }
}

TEST(Value, CountsAreWholeAndExact) {
  EXPECT_EQ(Value::scalar("1e6").count("n"), 1000000u);
  EXPECT_EQ(Value::scalar("18446744073709551615").count("n"), 18446744073709551615u);
  for (const char* text : {"-1", "1.5", "1e17", "18446744073709551616", "inf", "nan", "ten"}) {
    EXPECT_THROW(Value::scalar(text).count("n"), InputError) << text;
  }
}

TEST(Value, BooleansAreTrueOrFalseAndNothingElse) {
  EXPECT_TRUE(Value::scalar("true").boolean("b"));
  EXPECT_FALSE(Value::scalar("false").boolean("b"));
  for (const char* text : {"yes", "no", "1", "True", ""}) {
    EXPECT_THROW(Value::scalar(text).boolean("b"), InputError) << text;
  }
}

TEST(Value, ListsAndMapsAreNotScalars) {
  EXPECT_THROW(Value::list({}).number("x"), InputError);
  EXPECT_THROW(Value::map({}).string("x"), InputError);
  EXPECT_THROW(Value{}.string("x"), InputError);
}

TEST(Value, CanonicalTextDoesNotDependOnSpelling) {
  const Value one = Value::map({{"b", Value::scalar("1e3")}, {"a", Value::scalar("x")}});
  const Value two = Value::map({{"a", Value::scalar("x")}, {"b", Value::scalar("1000.0")}});
  EXPECT_EQ(one.canonical(), two.canonical());
  EXPECT_EQ(one.canonical(), R"({"a":"x","b":1000})");
}

TEST(Value, CanonicalTextTellsDifferentContentsApart) {
  const Value joined = Value::list({Value::scalar("a,b")});
  const Value split = Value::list({Value::scalar("a"), Value::scalar("b")});
  const Value quote = Value::list({Value::scalar("a\",\"b")});
  EXPECT_NE(joined.canonical(), split.canonical());
  EXPECT_NE(quote.canonical(), split.canonical());
  EXPECT_NE(Value{}.canonical(), Value::scalar("null").canonical());
}

TEST(Value, PlacesAreShownAsFarAsTheyAreKnown) {
  EXPECT_EQ(to_string({"suite.yaml", 12, 5}), "suite.yaml:12:5");
  EXPECT_EQ(to_string({"suite.yaml", 0, 0}), "suite.yaml");
  EXPECT_EQ(to_string({}), "");
  EXPECT_STREQ(InputError({}, "wrong").what(), "wrong");
}

TEST(Nearest, SuggestsWhatIsOneSlipAway) {
  const std::vector<std::string> known = {"scene", "radius", "light"};
  EXPECT_EQ(nearest("sceen", known), "scene");
  EXPECT_EQ(nearest("radious", known), "radius");
  EXPECT_EQ(nearest("lihgt", known), "light");
  EXPECT_EQ(nearest("turbidity", known), "");
  EXPECT_EQ(nearest("x", {"y"}), "");
  EXPECT_EQ(nearest("scene", {}), "");
}

TEST(Nearest, SuggestsTheShortestThatBeginsSo) {
  const std::vector<std::string> known = {"luminaire/area", "luminaire/hemispheres",
                                          "luminaire/hemisphere"};
  EXPECT_EQ(nearest("luminaire/hemi", known), "luminaire/hemisphere");
  EXPECT_EQ(nearest("lu", known), "");
  EXPECT_EQ(nearest("--s", {"--set", "--seed"}), "") << "dashes are no letters";
  EXPECT_EQ(nearest("--thr", {"--set", "--threads"}), "--threads");
}

TEST(Flow, ReadsScalarsListsAndMaps) {
  EXPECT_EQ(parse_flow("triangle").text(), "triangle");
  EXPECT_EQ(parse_flow("null").kind(), Value::Kind::null);
  EXPECT_EQ(parse_flow("[0, [1e1, b], {}]").canonical(), R"([0,[10,"b"],{}])");
  EXPECT_EQ(parse_flow("{disc: {radius: .3, at: [0, 1]}, n: 2}").canonical(),
            R"({"disc":{"at":[0,1],"radius":0.3},"n":2})");
}

TEST(Flow, RefusesWhatIsNotFlow) {
  for (const char* text : {"[1", "[1 2", "{a}", "{a: }", "[1] 2", "[,]", ""}) {
    EXPECT_THROW(parse_flow(text), std::logic_error) << text;
  }
}

}  // namespace
}  // namespace assay
