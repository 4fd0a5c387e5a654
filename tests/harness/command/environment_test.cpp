#include "harness/command/program.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

using Variables = std::map<std::string, std::string>;
using Shard = std::optional<std::pair<unsigned, unsigned>>;

Environment of(const Variables& variables) {
  return [variables](const std::string& name) {
    const auto found = variables.find(name);
    return found == variables.end() ? "" : found->second;
  };
}

Shard taken(const Variables& variables, const RunOptions& given = {}) {
  RunOptions options = given;
  take_shard_from(of(variables), options);
  return options.shard;
}

TEST(ShardEnvironment, CountsFromZeroWhereTheFlagCountsFromOne) {
  EXPECT_EQ(taken({}), Shard());
  EXPECT_EQ(taken({{"GTEST_TOTAL_SHARDS", "1"}, {"GTEST_SHARD_INDEX", "0"}}), Shard());
  EXPECT_EQ(taken({{"GTEST_TOTAL_SHARDS", "4"}, {"GTEST_SHARD_INDEX", "0"}}), Shard({1, 4}));
  EXPECT_EQ(taken({{"TEST_TOTAL_SHARDS", "4"}, {"TEST_SHARD_INDEX", "3"}}), Shard({4, 4}));
}

TEST(ShardEnvironment, GoogleTestsVariablesComeBeforeBazels) {
  EXPECT_EQ(taken({{"GTEST_TOTAL_SHARDS", "4"},
                   {"GTEST_SHARD_INDEX", "1"},
                   {"TEST_TOTAL_SHARDS", "5"},
                   {"TEST_SHARD_INDEX", "2"}}),
            Shard({2, 4}));
}

TEST(ShardEnvironment, TheFlagWinsAndTouchesNoStatusFile) {
  const Workplace place;
  const std::string status = place.file("status");
  EXPECT_EQ(taken({{"GTEST_TOTAL_SHARDS", "4"},
                   {"GTEST_SHARD_INDEX", "1"},
                   {"GTEST_SHARD_STATUS_FILE", status}},
                  {.shard = std::pair(3U, 3U)}),
            Shard({3, 3}));
  EXPECT_FALSE(std::filesystem::exists(status));
}

TEST(ShardEnvironment, MakesBothStatusFiles) {
  const Workplace place;
  taken({{"GTEST_TOTAL_SHARDS", "4"},
         {"GTEST_SHARD_INDEX", "1"},
         {"GTEST_SHARD_STATUS_FILE", place.file("one")},
         {"TEST_SHARD_STATUS_FILE", place.file("two")}});
  EXPECT_TRUE(std::filesystem::exists(place.file("one")));
  EXPECT_TRUE(std::filesystem::exists(place.file("two")));
  EXPECT_THAT(refusal([&] {
                taken({{"TEST_SHARD_STATUS_FILE", place.file("no/such/folder")}});
              }),
              HasSubstr("cannot be written"));
}

TEST(ShardEnvironment, HalfOrWrongIsRefused) {
  const auto refused = [](const Variables& variables) {
    return refusal([&] { taken(variables); });
  };
  EXPECT_EQ(refused({{"GTEST_TOTAL_SHARDS", "4"}}),
            "GTEST_TOTAL_SHARDS is set and GTEST_SHARD_INDEX is not: set both, or neither");
  EXPECT_EQ(refused({{"TEST_SHARD_INDEX", "4"}}),
            "TEST_SHARD_INDEX is set and TEST_TOTAL_SHARDS is not: set both, or neither");
  EXPECT_EQ(refused({{"GTEST_TOTAL_SHARDS", "4"}, {"GTEST_SHARD_INDEX", "4"}}),
            "GTEST_SHARD_INDEX is 4, but of 4 shards the last is 3");
  EXPECT_THAT(refused({{"GTEST_TOTAL_SHARDS", "0"}, {"GTEST_SHARD_INDEX", "0"}}),
              HasSubstr("GTEST_TOTAL_SHARDS must be a whole number, 1 or more"));
  EXPECT_THAT(refused({{"GTEST_TOTAL_SHARDS", "x"}, {"GTEST_SHARD_INDEX", "0"}}),
              HasSubstr("GTEST_TOTAL_SHARDS must be a whole number"));
  EXPECT_EQ(refused({{"GTEST_TOTAL_SHARDS", "99999999999"}, {"GTEST_SHARD_INDEX", "0"}}),
            "GTEST_TOTAL_SHARDS is too large");
}

}  // namespace
}  // namespace assay::harness
