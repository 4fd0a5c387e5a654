#include <nlohmann/json.hpp>

#include "reports/report_formats.h"
#include "reports/words/text.h"
#include "tests/reports/prelude.h"
#include "tests/reports/without_times.h"

namespace assay::reports {
namespace {

using Json = nlohmann::ordered_json;

// The message that reading the text gives.
std::string refusal(const std::string& text) {
  return thrown<ReadError>([&] { read_json(text, "run.json"); });
}

TEST(Json, MissingNumbersAreNullAndNonFiniteOnesAreNamed) {
  Record record = example_record();
  reports::Test& test = record.suites[0].tests[0];
  test.detect = std::nullopt;
  test.allow = std::numeric_limits<double>::quiet_NaN();
  test.detectable = std::numeric_limits<double>::infinity();
  test.power = -std::numeric_limits<double>::infinity();
  const Json written = Json::parse(json(record))["suites"][0]["tests"][0];
  EXPECT_TRUE(written["detect"].is_null());
  EXPECT_EQ(written["allow"], "NaN");
  EXPECT_EQ(written["detectable"], "Infinity");
  EXPECT_EQ(written["power"], "-Infinity");
  const reports::Test read = read_json(json(record), "run.json").suites[0].tests[0];
  EXPECT_FALSE(read.detect.has_value());
  EXPECT_TRUE(std::isnan(read.allow.value()));
  EXPECT_EQ(read.detectable, test.detectable);
  EXPECT_EQ(read.power, test.power);
}

TEST(Json, DoublesReadBackBitForBit) {
  Record record = example_record();
  const std::vector<double> values = {
      0.1,  1.0 / 3,     std::numbers::pi,       5e-324, 1.7976931348623157e308, -0.0,
      1e22, 123456789.0, 2.2250738585072014e-308};
  record.suites[0].tests[0].channels[0].distribution.parameters = values;
  const Record read = read_json(json(record), "run.json");
  const auto& back = read.suites[0].tests[0].channels[0].distribution.parameters;
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(back[i], values[i]);
    EXPECT_EQ(std::signbit(back[i]), std::signbit(values[i]));
  }
}

// The keys anywhere in the tree, by the name of their object. The value is true if any of them
// differs from the default.
void collect(const Json& node, const std::string& owner, std::map<std::string, bool>& keys) {
  for (const auto& item : node.items()) {
    const Json& value = item.value();
    const std::string key = node.is_object() ? owner + "." + item.key() : owner;
    const bool empty = value.is_null() || value == "" || value == 0 || value == false ||
                       (value.is_structured() && value.empty());
    if (node.is_object()) keys[key] |= !empty;
    if (value.is_structured()) collect(value, node.is_object() ? item.key() : owner, keys);
  }
}

// Text of the second suite is repaired on writing, so that it cannot read back the same.
Record example_of_valid_text() {
  Record record = example_record();
  record.suites.erase(record.suites.begin() + 1);
  record.suites[0].timed = true;
  return record;
}

TEST(Json, ReadingGivesBackEveryMember) {
  const Record record = example_of_valid_text();
  EXPECT_TRUE(read_json(json(record), "run.json") == record);
}

// Without this the test above could not see a member that has no key.
TEST(Json, EveryKeyOfTheExampleHasAValueSomewhere) {
  std::map<std::string, bool> keys;
  collect(Json::parse(json(example_of_valid_text())), "record", keys);
  EXPECT_GT(keys.size(), 100u);
  for (const auto& [key, has_value] : keys) EXPECT_TRUE(has_value) << key;
}

TEST(Json, ASavedRunGivesTheSamePage) {
  const Record record = example_record();
  EXPECT_EQ(html(read_json(json(record), "run.json")), html(record));
}

/// Without the members that are written and never read.
std::string as_read(const std::string& text) {
  const auto keep = [](int, Json::parse_event_t event, Json& parsed) {
    return event != Json::parse_event_t::key || (parsed != "display" && parsed != "answers");
  };
  return Json::parse(text, keep).dump();
}

RC_GTEST_PROP(Json, WritingAndReadingLoseNothing, ()) {
  const std::string once = json(random_record());
  RC_ASSERT(clean(once) == once);
  const std::string twice = json(read_json(once, "run.json"));
  RC_ASSERT(as_read(twice) == as_read(once));
  // Cleaning may change the order of names. From then on suspects and answers stay the same.
  RC_ASSERT(json(read_json(twice, "run.json")) == twice);
}

TEST(Json, WithoutTimesClearsEveryTimeAndNothingElse) {
  const Record record = example_record();
  Record later = record;
  later.started = "2031-01-01T00:00:00Z";
  later.seconds *= 2;
  later.environment.threads = 64;
  for (Suite& suite : later.suites) {
    for (EstimatorSummary& estimator : suite.estimators) estimator.cost.seconds += 1;
    for (reports::Test& test : suite.tests) {
      for (Sample& sample : test.samples) sample.cost.seconds += 1;
    }
  }
  EXPECT_NE(json(later), json(record));
  EXPECT_EQ(json(without_times(later)), json(without_times(record)));
  EXPECT_EQ(json(without_times(record)).find("83.25"), std::string::npos);
  later.suites[0].tests[0].samples[0].cost.samples += 1;
  EXPECT_NE(json(without_times(later)), json(without_times(record)));
}

TEST(ReadJson, NamesFileAndReasonForTextThatIsNotARecord) {
  EXPECT_EQ(refusal(""), "run.json: not a whole JSON text: it ends too early");
  EXPECT_EQ(refusal("{\n  \"a\": x}"), "run.json: not JSON: syntax error at line 2, column 8");
  EXPECT_EQ(refusal("{}"), "run.json: not a record of assay: the key \"schema\" is missing");
  EXPECT_EQ(refusal("[]"), "run.json: not a record of assay: the key \"schema\" is missing");
  EXPECT_EQ(refusal("{\"a\": 1e999}"),
            "run.json: not readable: a number is out of a double's range");
  EXPECT_EQ(refusal("{\"schema\": 1, \"schema\": 1}"),
            "run.json: the key \"schema\" stands twice in one object");
}

TEST(ReadJson, RefusesEveryTruncation) {
  const std::string whole = json(example_record());
  for (std::size_t length = 0; length + 1 < whole.size(); length += 997)
    ASSERT_EQ(refusal(whole.substr(0, length)), refusal("")) << length;
}

// Version 1 had no sentences, no means of nights, and no effects of looks and of findings in
// images.
TEST(ReadJson, ReadsTheFirstVersion) {
  Record record = example_of_valid_text();
  Json tree = Json::parse(json(record));
  tree["schema"] = 1;
  tree.erase("display");
  for (Json& suite : tree["suites"]) {
    suite.erase("display");
    for (Json& test : suite["tests"]) {
      for (const char* key : {"display", "paired", "advice", "no_replay"}) test.erase(key);
      for (Json& look : test["looks"]) look.erase("effect");
      if (!test["image"].is_object()) continue;
      test["image"]["winner"].erase("effect");
      for (Json& group : test["image"]["groups"]) group.erase("effect");
    }
  }
  for (Json& series : tree["ledger"]["series"]) {
    for (Json& night : series["nights"]) night.erase("mean");
  }
  for (LedgerSeries& series : record.ledger.series) {
    for (LedgerNight& night : series.nights) night.mean.reset();
  }
  for (Suite& suite : record.suites) {
    for (reports::Test& test : suite.tests) {
      test.paired = false;
      test.advice.reset();
      test.no_replay.clear();
      for (Look& look : test.looks) look.effect.reset();
      if (!test.image) continue;
      test.image->winner.effect.reset();
      for (ImageFinding& group : test.image->groups) group.effect.reset();
    }
  }
  EXPECT_TRUE(read_json(tree.dump(), "run.json") == record);
}

TEST(ReadJson, TextIsCleanedAsItWouldBeWritten) {
  Json tree = Json::parse(json(example_record()));
  tree["note"] = "a\x1b[31mb\u202Ec";
  const Record record = read_json(tree.dump(), "run.json");
  EXPECT_EQ(record.note, clean("a\x1b[31mb\u202Ec"));
  EXPECT_EQ(json(read_json(json(record), "run.json")), json(record));
}

TEST(ReadJson, NamesThePlaceOfAMistake) {
  std::ifstream table(ASSAY_SOURCE_DIR "/tests/tables/refused_records.txt");
  int cases = 0;
  for (std::string line; std::getline(table, line);) {
    if (!line.starts_with('{')) continue;
    const std::size_t arrow = line.find(" => ");
    const Json patch = Json::parse("[" + line.substr(0, arrow) + "]");
    EXPECT_EQ(refusal(Json::parse(json(example_record())).patch(patch).dump()),
              "run.json: " + line.substr(arrow + 4));
    ++cases;
  }
  EXPECT_EQ(cases, 8);
}

TEST(ReadJson, SurvivesDeepNesting) {
  const std::string deep(200000, '[');
  EXPECT_EQ(refusal(deep), "run.json: not a whole JSON text: it ends too early");
  EXPECT_EQ(refusal("{\"schema\": 2, \"tool\": " + deep + std::string(200000, ']') + "}"),
            "run.json: tool: should be an object, but is array");
}

}  // namespace
}  // namespace assay::reports
