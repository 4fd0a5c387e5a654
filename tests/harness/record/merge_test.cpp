#include "harness/record/record_of.h"
#include "harness/suite/run_options.h"
#include "reports/report_formats.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

const std::string merged_suite = good_suite("  - {name: off, claim: mean(hemisphere) == 0.1}\n");

/// The record, written and read again.
reports::Record saved(const reports::Record& record) {
  return reports::read_json(reports::json(record), "record");
}

std::vector<ShardFile> shards_of(const std::vector<std::string>& files, unsigned count,
                                 RunOptions options = {}) {
  std::vector<ShardFile> shards;
  for (unsigned i = 1; i <= count; ++i) {
    options.shard = {i, count};
    options.threads = i;
    shards.push_back({std::to_string(i) + ".json", saved(run_files(files, options))});
  }
  return shards;
}

using Merge = Placed;

TEST_F(Merge, OfShardsInAnyOrderIsOneRunByteForByteApartFromTimes) {
  const std::vector<std::string> files{
      place.write("good.yaml", merged_suite),
      place.write("other.yaml", good_suite("  - {claim: mean(idle) <= 7}\n"))};
  const std::string whole = numbers_of(run_files(files, {.seed = 3}));
  for (const unsigned count : {1U, 2U, 13U}) {
    std::vector<ShardFile> shards = shards_of(files, count, {.seed = 3});
    EXPECT_EQ(numbers_of(merge(shards)), whole) << count;
    std::reverse(shards.begin(), shards.end());
    std::rotate(shards.begin(), shards.begin() + 1, shards.end());
    EXPECT_EQ(numbers_of(merge(shards)), whole) << count;
  }
}

TEST_F(Merge, OfFilteredShardsIsOneFilteredRun) {
  const std::string file = place.write("good.yaml", merged_suite);
  const RunOptions options{.selection = {.filters = {"*mean(*"}}};
  const reports::Record whole = run_files({file}, options);
  EXPECT_NE(whole.note, "");
  EXPECT_EQ(numbers_of(merge(shards_of({file}, 3, options))), numbers_of(whole));
}

// The claim `close` is off by 2.7 standard errors of its 1000 observations, p = .007. That is above
// its share .005 of alpha .01. Once `far` is refuted, Holm's adjusted p stays below .01, which
// decides nothing.
TEST_F(Merge, AVerdictIsTheTestsOwnAloneFilteredShardedMergedAndWhole) {
  const std::string head =
      "suite: two\nestimators:\n  normal: {plugin: analytic/normal, mean: 2, primaries: 1}\n"
      "tests:\n  - {name: far, claim: mean(normal) == 3}\n";
  const auto with = [&](double value) {
    return head + "  - {name: close, claim: mean(normal) == " + std::to_string(value) + "}\n";
  };
  const reports::Sample sample = run_text(with(2)).suites[0].tests[1].samples[0];
  const double error = std::sqrt(*sample.variance / static_cast<double>(sample.secondaries));
  const std::string file = place.write("two.yaml", with(*sample.mean - 2.7 * error));
  const std::vector<ShardFile> shards = shards_of({file}, 2);
  const reports::Record whole = run_files({file});
  const reports::Record merged = merge(shards);
  const reports::Test& test = whole.suites[0].tests[1];
  EXPECT_EQ(numbers_of(merged), numbers_of(whole));
  EXPECT_EQ(whole.suites[0].tests[0].verdict, Verdict::fail);
  EXPECT_EQ(test.verdict, Verdict::pass);
  EXPECT_LT(*test.channels[0].p_adjusted, .01);
  const reports::Record filtered = run_files({file}, {.selection = {.filters = {"*close"}}});
  // Both are about one stream, so one shard takes them.
  for (const reports::Test& other :
       {shards[0].record.suites[0].tests[1], filtered.suites[0].tests[0]}) {
    EXPECT_EQ(other.verdict, test.verdict);
    EXPECT_EQ(other.message, test.message);
    EXPECT_EQ(other.channels[0].effect, test.channels[0].effect);
  }
}

TEST_F(Merge, KeepsTheLongestTimesAndTheirSum) {
  std::vector<ShardFile> shards = shards_of({place.write("good.yaml", merged_suite)}, 2);
  shards[0].record.started = "2026-01-02T00:00:00Z";
  shards[1].record.started = "2026-01-01T00:00:00Z";
  shards[0].record.seconds = 2;
  shards[1].record.seconds = 3;
  const reports::Record merged = merge(shards);
  EXPECT_EQ(merged.started, "2026-01-01T00:00:00Z");
  EXPECT_EQ(merged.seconds, 5);
}

// Whichever shards are there, the tests of the others are named, and all stand in their order.
TEST_F(Merge, TheTestsOfAMissingShardAreSkipped) {
  const std::string file = place.write("good.yaml", merged_suite);
  const reports::Record whole = run_files({file});
  const std::vector<ShardFile> shards = shards_of({file}, 3);
  for (const std::vector<std::size_t>& there : {std::vector<std::size_t>{0}, {1, 2}}) {
    std::vector<ShardFile> some;
    for (const std::size_t index : there) some.push_back(shards[index]);
    const reports::Record merged = saved(merge(some));
    std::size_t skipped = 0;
    std::size_t rest = 0;
    for (const ShardFile& shard : shards) rest += shard.record.suites[0].tests.size();
    for (const ShardFile& shard : some) rest -= shard.record.suites[0].tests.size();
    ASSERT_EQ(merged.suites[0].tests.size(), whole.suites[0].tests.size());
    for (std::size_t i = 0; i < whole.suites[0].tests.size(); ++i) {
      const reports::Test& test = merged.suites[0].tests[i];
      EXPECT_EQ(test.id, whole.suites[0].tests[i].id);
      EXPECT_EQ(test.line, whole.suites[0].tests[i].line);
      if (test.verdict != Verdict::skipped) {
        EXPECT_EQ(test.verdict, whole.suites[0].tests[i].verdict);
        continue;
      }
      ++skipped;
      EXPECT_FALSE(test.ok);
      EXPECT_THAT(test.message, HasSubstr(" of 3 is missing"));
    }
    EXPECT_GT(skipped, 0U);
    EXPECT_EQ(skipped, rest);
    EXPECT_THAT(merged.note, HasSubstr(there.size() == 1 ? "skipped: 2, 3;" : "skipped: 1;"));
  }
}

// The dear test of the first estimator weighs as much as all others; the two of one stream stay
// together.
TEST(Shards, AreBalancedByPlannedCostAndShareStreams) {
  const std::string text = R"(suite: costs
estimators:
  dear: {plugin: analytic/normal, mean: 1}
  a: {plugin: analytic/normal, mean: 2}
  b: {plugin: analytic/normal, mean: 3}
  c: {plugin: analytic/normal, mean: 4}
tests:
  - {name: a1, claim: mean(a) == 2, secondaries: 3000}
  - {name: dear, claim: mean(dear) == 1, secondaries: 9000}
  - {name: b, claim: mean(b) == 3, secondaries: 4000}
  - {name: a2, claim: mean(a) <= 2, secondaries: 2000}
  - {name: c, claim: mean(c) == 4, secondaries: 1000}
)";
  const Workplace place;
  std::vector<std::vector<std::string>> names;
  for (const ShardFile& shard : shards_of({place.write("costs.yaml", text)}, 2)) {
    names.emplace_back();
    for (const reports::Test& test : shard.record.suites[0].tests) {
      names.back().push_back(test.name);
    }
  }
  EXPECT_THAT(names, testing::ElementsAre(testing::ElementsAre("dear"),
                                          testing::ElementsAre("a1", "b", "a2", "c")));
}

class Refusing : public InFolder {
 protected:
  Refusing() : file_(place_.write("good.yaml", merged_suite)), shards_(shards_of({file_}, 2)) {}

  std::string refused(const std::vector<ShardFile>& shards) {
    return refusal([&] { merge(shards); });
  }
  /// The refusal of a second shard that was run again with these options.
  std::string refused_with(RunOptions options) {
    options.shard = {2U, 2U};
    return refused({shards_[0], {"b.json", run_files({file_}, options)}});
  }

  std::string file_;
  std::vector<ShardFile> shards_;
};

TEST_F(Refusing, ShardsThatAreDoubledOrNoneAreNamed) {
  EXPECT_THAT(refused({shards_[0], shards_[1], {"copy.json", shards_[0].record}}),
              HasSubstr("is shard 1 of 2, and so is `1.json`"));
  EXPECT_THAT(refused({shards_[0], {"whole.json", run_files({file_})}}),
              HasSubstr("is a whole run, not a shard"));
}

TEST_F(Refusing, OtherOptionsOrSuitesAreAnotherRun) {
  EXPECT_THAT(refused_with({.seed = 2}), HasSubstr("seed `2` here, `1` there; run one"));
  EXPECT_THAT(refused_with({.selection = {.filters = {"*"}}}), HasSubstr("command `"));
  EXPECT_THAT(refused_with({.command = "assay run --set normal.mean=3"}), HasSubstr("command `"));
  EXPECT_THAT(refused_with({.alpha = 0.02}), HasSubstr("alpha and beta"));
  const ShardFile other{"b.json", run_files({file_}, {.shard = std::pair(2U, 3U)})};
  EXPECT_THAT(refused({shards_[0], other}), HasSubstr("number of shards `3` here, `2` there"));
  place_.write("good.yaml", merged_suite + "# a remark\n");
  EXPECT_THAT(refused_with({}), HasSubstr("suites and data `"));
}

TEST_F(Refusing, OtherDataAreAnotherRun) {
  const std::string text =
      "suite: data\nestimators:\n  data: {plugin: recorded, file: data.txt}\n"
      "tests:\n  - {claim: mean(data) == 2}\n  - {claim: mean(data) <= 9}\n";
  file_ = place_.write("data.yaml", text);
  place_.write("data.txt", "1\n2\n3\n");
  shards_ = shards_of({file_}, 2);
  place_.write("data.txt", "1\n2\n4\n");
  EXPECT_THAT(refused_with({}), HasSubstr("suites and data `"));
}

TEST_F(Refusing, AnotherVersionOrMachineIsAnotherRun) {
  std::vector<ShardFile> shards = shards_;
  shards[1].record.tool.commit = "0123456789ab";
  EXPECT_THAT(refused(shards), HasSubstr("version of the program `"));
  shards = shards_;
  shards[1].record.environment.isa = "sse4.2";
  EXPECT_THAT(refused(shards), HasSubstr("instruction set for rays `"));
}

TEST_F(Refusing, AnEditedRecordIsRefused) {
  for (const auto& edit : std::vector<void (*)(reports::Record&)>{
           [](reports::Record& r) { r.shard->suites.clear(); },
           [](reports::Record& r) { r.shard->suites[0].results.pop_back(); },
           [](reports::Record& r) { r.shard->suites[0].results[0].log_p.clear(); },
           [](reports::Record& r) { r.shard->suites[0].results[0].weight = 0; },
           [](reports::Record& r) { r.shard->index = 3; },
           [](reports::Record& r) { r.shard->suites[0].results[0].weight = 5; }}) {
    std::vector<ShardFile> shards = shards_;
    edit(shards[0].record);
    EXPECT_THAT(refused(shards), HasSubstr("edited?"));
  }
}

TEST(Shards, DoNotAddToALedger) {
  const Workplace place;
  const std::string file = place.write("good.yaml", merged_suite);
  EXPECT_THAT(refusal([&] {
                run_files({file}, {.shard = std::pair(1U, 2U), .ledger = place.file("nights")});
              }),
              HasSubstr("--ledger needs whole runs"));
}

}  // namespace
}  // namespace assay::harness
