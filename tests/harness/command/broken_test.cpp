#include "harness/command/commands.h"
#include "harness/record/record_of.h"
#include "reports/words/display.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

// `wrong` is refuted at its first look, `dear` takes many.
constexpr const char* hasty_suite = R"(suite: hasty
estimators:
  normal: {plugin: analytic/normal, mean: 2}
  never: {plugin: analytic/normal, mean: 7}
tests:
  - {name: easy, claim: mean(normal) == 2, secondaries: 100}
  - {name: dear, claim: mean(normal) == 2, detect: 0.1%}
  - {name: wrong, claim: mean(normal) == 3, detect: 0.1%}
  - {name: bug missed, claim: mean(normal) == 2, secondaries: 100, expect: fail}
  - {name: dear too, claim: mean(never) == 7, detect: 0.1%}
)";

struct Heard {
  reports::Record record;
  std::vector<std::string> broken;
};

Heard heard(const Workplace& place, const std::string& text, const RunOptions& options) {
  Heard all;
  all.record =
      run({load_suite(place.write("suite.yaml", text))}, options, silence,
          [&](const reports::Test& test) { all.broken.push_back(test.id + ": " + test.replay); });
  return all;
}

using BrokenClaims = Placed;

TEST_F(BrokenClaims, AreToldWithTheirCommandWhenTheyAreDecided) {
  const Heard all = heard(place, hasty_suite, {.command = "assay run"});
  const std::string again = "assay run " + place.file("suite.yaml") + " --seed 1 --filter ";
  EXPECT_THAT(all.broken, ElementsAre("suite/wrong: " + again + "suite/wrong",
                                      "suite/bug missed: " + again + "'suite/bug missed'"));
  EXPECT_EQ(reports::standings(all.record)[reports::Standing::broken], 2);
}

TEST_F(BrokenClaims, EndARunEarlyIfAsked) {
  const Heard all = heard(place, hasty_suite, {.fail_fast = true});
  EXPECT_EQ(all.broken.size(), 1U);  // the cheaper of the two
  for (const char* name : {"dear", "wrong", "dear too"}) {
    const reports::Test& test = test_named(all.record, name);
    EXPECT_EQ(test.verdict, Verdict::skipped);
    EXPECT_EQ(test.message, "the run ended early: `suite/bug missed` is broken");
    EXPECT_TRUE(test.samples.empty());
  }
  EXPECT_EQ(exit_code(all.record, InconclusivePolicy::report), 1);
  EXPECT_THAT(all.record.note, HasSubstr("not every test"));
}

// But for what the whole family says of a test.
TEST_F(BrokenClaims, HaveTheNumbersOfAWholeRun) {
  const reports::Record whole = heard(place, hasty_suite, {.threads = 1}).record;
  const reports::Record early = heard(place, hasty_suite, {.threads = 1, .fail_fast = true}).record;
  for (const char* name : {"easy", "bug missed"}) {
    EXPECT_EQ(raw(test_named(early, name)), raw(test_named(whole, name))) << name;
  }
  EXPECT_EQ(numbers_of(heard(place, hasty_suite, {.threads = 2, .fail_fast = true}).record),
            numbers_of(early));
}

TEST_F(BrokenClaims, EndNoRunWithoutOne) {
  const std::string sound =
      std::string(hasty_suite).substr(0, std::string(hasty_suite).find("  - {name: wrong"));
  EXPECT_EQ(numbers_of(heard(place, sound, {.threads = 1, .fail_fast = true}).record),
            numbers_of(heard(place, sound, {.threads = 1}).record));
}

TEST_F(BrokenClaims, EndARunBeforeItDrawsIfAnEstimatorCannotBePrepared) {
  const std::string broken =
      std::string(hasty_suite) + "  - {name: gone, claim: mean(gone) == 1}\n";
  std::string text = broken;
  text.insert(text.find("tests:"), "  gone: {plugin: process, command: [sh, -c, exit 3]}\n");
  const Heard all = heard(place, text, {.fail_fast = true});
  EXPECT_EQ(all.broken.size(), 1U);
  EXPECT_EQ(reports::standings(all.record)[reports::Standing::not_run], 5);
  EXPECT_THAT(all.record.suites[0].estimators,
              testing::Each(testing::Field(&reports::EstimatorSummary::secondaries, 0U)));
}

TEST_F(BrokenClaims, EndNoShardAndNoNight) {
  const std::string why = "--fail-fast ends a run early: leave --ledger and --shard out";
  for (const RunOptions& options :
       {RunOptions{.shard = {{1, 2}}, .fail_fast = true},
        RunOptions{.fail_fast = true, .ledger = place.file("n.ledger")}}) {
    EXPECT_EQ(thrown<InputError>([&] { heard(place, hasty_suite, options); }), why);
  }
}

}  // namespace
}  // namespace assay::harness
