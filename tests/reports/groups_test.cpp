#include "reports/record/groups.h"

#include <gtest/gtest.h>

namespace assay::reports {
namespace {

Suite suite_of(const std::vector<std::string>& names) {
  Suite suite;
  for (const std::string& name : names) {
    suite.estimators.push_back({});
    suite.estimators.back().name = name;
    suite.estimators.back().plugin = "plugin/" + name;
  }
  return suite;
}

std::vector<std::vector<std::string>> names(const std::vector<Suite>& groups) {
  std::vector<std::vector<std::string>> result;
  for (const Suite& group : groups) {
    result.emplace_back();
    for (const EstimatorSummary& estimator : group.estimators)
      result.back().push_back(estimator.name);
  }
  return result;
}

using Names = std::vector<std::vector<std::string>>;

TEST(Groups, EstimatorsThatNothingRelatesStandApart) {
  EXPECT_EQ(names(groups(suite_of({"a", "b", "c"}))), (Names{{"a"}, {"b"}, {"c"}}));
  EXPECT_TRUE(groups(Suite{}).empty());
}

TEST(Groups, AComparisonPutsTwoEstimatorsTogetherAndStaysWithThem) {
  Suite suite = suite_of({"a", "b", "c"});
  suite.comparisons.resize(1);
  suite.comparisons[0].first = "c";
  suite.comparisons[0].second = "a";
  const std::vector<Suite> all = groups(suite);
  EXPECT_EQ(names(all), (Names{{"a", "c"}, {"b"}}));
  EXPECT_EQ(all[0].comparisons.size(), 1u);
  EXPECT_TRUE(all[1].comparisons.empty());
}

TEST(Groups, AClaimOnTwoSourcesPutsThemTogether) {
  Suite suite = suite_of({"a", "b", "c"});
  suite.tests.resize(1);
  suite.tests[0].samples.resize(2);
  suite.tests[0].samples[0].estimator = "b";
  suite.tests[0].samples[1].estimator = "c";
  EXPECT_EQ(names(groups(suite)), (Names{{"a"}, {"b", "c"}}));
}

TEST(Groups, AMutantStandsWithItsOriginalOfTheSameParameters) {
  Suite suite = suite_of({"a", "b", "m"});
  suite.estimators[2].original = "plugin/b";
  EXPECT_EQ(names(groups(suite)), (Names{{"a"}, {"b", "m"}}));
  suite.estimators[2].parameters = "scene=other";
  EXPECT_EQ(names(groups(suite)), (Names{{"a"}, {"b"}, {"m"}}));
}

TEST(Groups, RelationsChain) {
  Suite suite = suite_of({"a", "b", "c", "d"});
  suite.comparisons.resize(2);
  suite.comparisons[0].first = "d";
  suite.comparisons[0].second = "b";
  suite.comparisons[1].first = "a";
  suite.comparisons[1].second = "d";
  EXPECT_EQ(names(groups(suite)), (Names{{"a", "b", "d"}, {"c"}}));
}

}  // namespace
}  // namespace assay::reports
