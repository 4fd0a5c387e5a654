#include "harness/command/commands.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

std::string sampled(const SampleArguments& arguments) {
  const Said said = said_by([&] { return sample(arguments); });
  EXPECT_EQ(said.code, 0);
  return said.text;
}

std::vector<std::string> rows(const std::string& text) {
  std::vector<std::string> found = lines(text);
  std::erase_if(found, [](const std::string& line) { return line.starts_with("#"); });
  return found;
}

using Samples = Placed;

TEST_F(Samples, PrintsOneObservationALineAndIsAPrefixOfALongerOne) {
  const std::vector<std::string> few = rows(sampled({.source = "analytic/normal"}));
  const std::vector<std::string> many =
      rows(sampled({.source = "analytic/normal", .secondaries = 50}));
  EXPECT_EQ(many.size(), 50U);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
  EXPECT_NE(rows(sampled({.source = "analytic/normal", .seed = 2})), few);
}

TEST_F(Samples, OfASamplerHasItsMarginals) {
  EXPECT_THAT(sampled({.source = "luminaire/hemisphere.direction"}),
              HasSubstr("# columns: theta phi\n"));
  const std::string named = sampled({.source = "luminaire/hemisphere.direction.theta"});
  EXPECT_THAT(named, HasSubstr("# columns: theta\n"));
  EXPECT_EQ(sampled({.source = "luminaire/hemisphere.theta"}), named);
}

TEST_F(Samples, RefusesMoreRowsThanThereAre) {
  const std::string option = "data=recorded,file=" + place.write("data.txt", "1\n2\n3\n");
  const std::string text =
      refusal([&] { sample({.source = "data", .estimators = {option}, .secondaries = 4}); });
  EXPECT_THAT(text, HasSubstr("has 3 rows"));
}

TEST_F(Samples, QuotesNamesThatWouldBeSeveral) {
  const auto again = [&](const std::string& file, const std::string& text) {
    return sampled(
        {.source = "data", .estimators = {"data=recorded,file=" + place.write(file, text)}});
  };
  const std::string header = "# columns: \"x, mean\" y \"a \"\"b\"\"\"\n1 2 3\n4 5 6\n";
  const std::string text = again("data.csv", "\"x, mean\",y,\"a \"\"b\"\"\"\n1,2,3\n4,5,6\n");
  EXPECT_THAT(text, HasSubstr(header));
  EXPECT_THAT(again("data.txt", text), HasSubstr(header));
}

// The file says which stream it was drawn from, and the estimator steps aside.
TEST_F(Samples, IsComparedWithItsOwnEstimatorOnAnotherCopyOfTheStream) {
  place.write("data.txt", sampled({.source = "analytic/normal", .secondaries = 300}));
  const reports::Record record = run_files({place.write("suite.yaml", R"(suite: copies
estimators:
  direct: {plugin: analytic/normal, primaries: 1}
  data: {plugin: recorded, file: data.txt}
tests:
  - {name: first, claim: mean(direct) == mean(data)}
  - {name: second, claim: mean(data) == mean(direct)}
  - {name: laws, claim: distribution(data) == distribution(direct)}
  - {name: alone, claim: mean(direct) == 0, secondaries: 300}
)")});
  const reports::Number of_stream = test_named(record, "alone").samples[0].mean;
  EXPECT_EQ(test_named(record, "first").samples[1].mean, of_stream);
  EXPECT_NE(test_named(record, "first").samples[0].mean, of_stream);
  EXPECT_EQ(test_named(record, "second").samples[0].mean, of_stream);
  EXPECT_NE(test_named(record, "second").samples[1].mean, of_stream);
  EXPECT_NE(test_named(record, "laws").channels[0].statistic, 0);
}

TEST_F(Samples, TwiceOfOneStreamIsNotIndependent) {
  place.write("few.txt", sampled({.source = "analytic/normal", .secondaries = 30}));
  place.write("many.txt", sampled({.source = "analytic/normal", .secondaries = 50}));
  place.write("seed2.txt", sampled({.source = "analytic/normal", .secondaries = 50, .seed = 2}));
  const auto refused = [&](const std::string& other) {
    return refusal([&] {
      run_files({place.write("suite.yaml", R"(suite: copies
estimators:
  few: {plugin: recorded, file: few.txt}
  many: {plugin: recorded, file: )" + other + R"(}
tests:
  - {claim: mean(few) == mean(many)}
)")});
    });
  };
  EXPECT_THAT(refused("many.txt"), HasSubstr("drawn from the same stream"));
  EXPECT_EQ(refused("seed2.txt"), "(nothing was refused)");
}

// `recorded` reads the output of `sample`; its moments are those of the estimator.
TEST_F(Samples, IsWhatRecordedReads) {
  place.write("data.txt",
              sampled({.source = "analytic/normal", .secondaries = 300, .primaries = 4}));
  const reports::Record record = run_files({place.write("suite.yaml", R"(suite: round trip
estimators:
  direct: {plugin: analytic/normal, primaries: 4}
  data: {plugin: recorded, file: data.txt}
tests:
  - {name: direct, claim: mean(direct) == 0.5, secondaries: 300}
  - {name: data, claim: mean(data) == 0.5}
)")});
  const reports::Sample& direct = test_named(record, "direct").samples[0];
  const reports::Sample& data = test_named(record, "data").samples[0];
  EXPECT_EQ(data.secondaries, 300);
  EXPECT_EQ(data.mean, direct.mean);
  EXPECT_EQ(data.variance, direct.variance);
}

}  // namespace
}  // namespace assay::harness
