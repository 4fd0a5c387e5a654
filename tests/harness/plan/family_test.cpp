#include "harness/plan/plan.h"
#include "tests/harness/questions.h"

namespace assay::harness {
namespace {

std::unique_ptr<Asked> asked_of_shares(const std::string& tests) {
  return ask_text(R"(suite: shares
alpha: 0.04
beta: 0.02
estimators:
  darts: {plugin: analytic/dart_throwing}
  scaled: {plugin: mutants/scaled}
tests:
)" + tests);
}

std::vector<FamilyPlace> places_of(const std::string& tests) {
  const auto asked = asked_of_shares(tests);
  return places(asked->suite, asked->questions);
}

TEST(Family, SharesAlphaByWeight) {
  const std::vector<FamilyPlace> all = places_of(
      "  - {claim: mean(darts) == analytic, weight: 3}\n"
      "  - {claim: mean(darts) <= 4}\n");
  EXPECT_TRUE(all[0].inside);
  EXPECT_DOUBLE_EQ(all[0].weight, 0.75);
  EXPECT_DOUBLE_EQ(all[0].share.alpha, 0.03);
  EXPECT_DOUBLE_EQ(all[1].share.alpha, 0.01);
  EXPECT_DOUBLE_EQ(all[0].share.beta, 0.02);
}

TEST(Family, SplitsAClaimsShareOverItsChannels) {
  const Workplace place;
  const std::string data = place.write("data.txt", "# columns: a b\n1 2\n3 4\n5 6\n");
  const auto asked = ask_text(
      "suite: channels\nalpha: 0.04\nestimators:\n  darts: {plugin: "
      "analytic/dart_throwing}\n  data: {plugin: recorded, file: '" +
      data + R"('}
tests:
  - {claim: mean(darts) == analytic}
  - {claim: mean(data) == 3}
)");
  ASSERT_EQ(asked->questions[1].channel_count(), 2);
  const std::vector<FamilyPlace> all = places(asked->suite, asked->questions);
  EXPECT_DOUBLE_EQ(all[0].share.alpha, 0.02);
  EXPECT_DOUBLE_EQ(all[1].share.alpha, 0.01);
  EXPECT_DOUBLE_EQ(all[0].weight + 2 * all[1].weight, 1);
}

constexpr const char* with_mutants = R"(  - {claim: mean(darts) == analytic, weight: 3}
  - {claim: mean(darts) <= 4}
  - {name: expected, claim: mean(darts) == 3, expect: fail, weight: 7}
  - {name: mutant, claim: mean(scaled) == 6, expect: fail}
)";

TEST(Family, LeavesMutantsAndExpectedFailuresOutside) {
  const std::vector<FamilyPlace> all = places_of(with_mutants);
  EXPECT_DOUBLE_EQ(all[0].share.alpha, 0.03);
  EXPECT_DOUBLE_EQ(all[1].share.alpha, 0.01);
  for (const std::size_t i : {2U, 3U}) {
    EXPECT_FALSE(all[i].inside);
    EXPECT_EQ(all[i].weight, 0);
    EXPECT_DOUBLE_EQ(all[i].share.alpha, 0.01) << "the smallest share in the suite";
    EXPECT_DOUBLE_EQ(all[i].share.beta, 0.01) << "beta over their number";
  }
  EXPECT_FALSE(places_of("  - {claim: mean(darts) == analytic}\n"
                         "  - {claim: mean(scaled) == 6.5}\n")[1]
                   .inside)
      << "whatever is expected of it";
}

TEST(Family, OfMutantsAloneSharesAlphaAmongThem) {
  for (const FamilyPlace& place :
       places_of("  - {name: one, claim: mean(scaled) == 6, expect: fail}\n"
                 "  - {name: two, claim: mean(scaled) <= 6, expect: fail}\n")) {
    EXPECT_FALSE(place.inside);
    EXPECT_DOUBLE_EQ(place.share.alpha, 0.02);
    EXPECT_DOUBLE_EQ(place.share.beta, 0.01);
  }
}

// The numbers of those that can be tested are the same with and without the dead source.
TEST(Family, KeepsThePartOfATestThatCannotBeAsked) {
  for (const std::string dead : {"analytic", "expected", "mutant"}) {
    const auto asked = asked_of_shares(with_mutants);
    const std::vector<FamilyPlace> sound = places(asked->suite, asked->questions);
    std::vector<FamilyPlace> known;
    std::vector<Question> questions;
    for (std::size_t i = 0; i < asked->questions.size(); ++i) {
      const TestEntry& test = *asked->questions[i].test;
      const bool dies =
          dead == "analytic" ? test.expect == reports::Verdict::pass : test.name == dead;
      if (dies) continue;
      questions.push_back(asked->questions[i]);
      known.push_back(sound[i]);
    }
    ASSERT_LT(questions.size(), asked->questions.size()) << dead;
    const std::vector<FamilyPlace> all = places(asked->suite, questions);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_DOUBLE_EQ(all[i].weight, known[i].weight) << dead;
      EXPECT_DOUBLE_EQ(all[i].share.alpha, known[i].share.alpha) << dead;
      EXPECT_DOUBLE_EQ(all[i].share.beta, known[i].share.beta) << dead;
    }
  }
}

}  // namespace
}  // namespace assay::harness
