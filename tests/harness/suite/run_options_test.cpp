#include "harness/suite/run_options.h"

#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

const char* const selected_from = R"(suite: selection
estimators: {normal: {plugin: analytic/normal, mean: 2, primaries: 1}}
tests:
  - {name: first mean, claim: mean(normal) == 2, detect: 20%, tags: [mean, fast]}
  - {name: second mean, claim: mean(normal) <= 2, detect: 20%, tags: [mean, slow]}
  - {name: variance, claim: variance(normal) == 1, tags: [slow]}
  - {name: untagged, claim: variance(normal) <= 1}
)";

class SelectionOfTests : public InFolder {
 protected:
  std::vector<Suite> suites() const { return {load_suite(write("s.yaml", selected_from))}; }

  std::vector<std::string> names(const Selection& selection) const {
    std::vector<std::string> found;
    const std::vector<Suite> all = suites();
    for (const TestEntry& test : all[0].tests) {
      if (selects(selection, test)) found.push_back(test.name);
    }
    return found;
  }

  std::string said(const Selection& selection) const { return unmatched(suites(), selection); }
};

TEST_F(SelectionOfTests, ByTagTakesWhatHasAnyOfThem) {
  EXPECT_THAT(names({.tags = {"mean"}}), ElementsAre("first mean", "second mean"));
  EXPECT_THAT(names({.tags = {"fast", "slow"}}),
              ElementsAre("first mean", "second mean", "variance"));
  EXPECT_THAT(names({.tags = {"me*n"}}), IsEmpty());
}

TEST_F(SelectionOfTests, ByFilterTakesWhatOneIncludesAndNoneExcludes) {
  EXPECT_THAT(names({.filters = {"*fir?t*", "*untagged"}}), ElementsAre("first mean", "untagged"));
  EXPECT_THAT(names({.filters = {"-*mean"}}), ElementsAre("variance", "untagged"));
  EXPECT_THAT(names({.filters = {"*mean", "-*second*"}}), ElementsAre("first mean"));
  EXPECT_THAT(names({.filters = {"-*second*", "*mean"}}), ElementsAre("first mean"));
}

TEST_F(SelectionOfTests, ByBothTakesWhatBothSelect) {
  EXPECT_THAT(names({.filters = {"-*second*"}, .tags = {"mean"}}), ElementsAre("first mean"));
  EXPECT_EQ(names({}).size(), 4U);
}

TEST_F(SelectionOfTests, ReadsBackInAShell) {
  EXPECT_EQ(options_text(Selection{}), "");
  EXPECT_EQ(options_text(Selection{.filters = {"*mean", "-s/b"}, .tags = {"a b"}}),
            " --filter '*mean' --filter -s/b --tag 'a b'");
}

TEST_F(SelectionOfTests, SaysWhichTagsThereAre) {
  EXPECT_EQ(said({.tags = {"slow"}}), "");
  EXPECT_EQ(said({.tags = {"slow", "maen"}}),
            "--tag maen: no test has this tag; did you mean `mean`?\n");
  EXPECT_EQ(said({.tags = {"nightly"}}),
            "--tag nightly: no test has this tag; there is: fast, mean, slow\n");
  Suite bare = suites()[0];
  bare.tests.erase(bare.tests.begin(), bare.tests.begin() + 3);
  EXPECT_EQ(unmatched({bare}, {.tags = {"slow"}}),
            "--tag slow: no test has this tag; a test gets one by `tags: [slow]`\n");
}

TEST_F(SelectionOfTests, SaysHowIdsLook) {
  EXPECT_EQ(said({.filters = {"s/*mean"}}), "");
  EXPECT_EQ(said({.filters = {"mean"}}),
            "--filter mean matches no test\n  it must match a whole id, suite/name, where * and ? "
            "are wildcards; near it:\n    s/first mean\n    s/second mean\n");
  EXPECT_EQ(said({.filters = {"s/varaince"}}),
            "--filter s/varaince matches no test\n  it must match a whole id, suite/name, where * "
            "and ? are wildcards; near it:\n    s/variance\n");
  EXPECT_EQ(said({.filters = {"s/*", "zzz"}}),
            "--filter zzz matches no test\n  it must match a whole id, suite/name, where * and ? "
            "are wildcards; ids here:\n    s/first mean\n    s/second mean\n    s/variance\n    "
            "s/untagged\n");
}

TEST_F(SelectionOfTests, SaysThatNoTestIsLeft) {
  EXPECT_EQ(said({.filters = {"-*"}}), "no test is left by --filter '-*'\n");
  EXPECT_EQ(said({.filters = {"*variance"}, .tags = {"fast"}}),
            "no test is left by --filter '*variance' --tag fast\n");
  EXPECT_EQ(said({.filters = {"-zzz"}}), "");
}

// A part of a suite rests on fixed shares, whichever way it was chosen, and its numbers are those
// of the whole.
TEST_F(SelectionOfTests, ByTagIsThePartThatAFilterWouldBe) {
  const std::string file = place_.write("s.yaml", selected_from);
  const reports::Record tagged = run_files({file}, {.selection = {.tags = {"mean"}}});
  const reports::Record filtered = run_files({file}, {.selection = {.filters = {"*mean"}}});
  ASSERT_EQ(tagged.suites[0].tests.size(), 2U);
  ASSERT_EQ(filtered.suites[0].tests.size(), 2U);
  EXPECT_EQ(tagged.note, filtered.note);
  EXPECT_NE(tagged.note, run_files({file}).note);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(tagged.suites[0].tests[i].id, filtered.suites[0].tests[i].id);
    EXPECT_EQ(tagged.suites[0].tests[i].alpha, filtered.suites[0].tests[i].alpha);
    EXPECT_EQ(tagged.suites[0].tests[i].message, filtered.suites[0].tests[i].message);
  }
}

}  // namespace
}  // namespace assay::harness
