#include "harness/record/shard_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "estimators/ready_made.h"
#include "harness/base/text_hash.h"
#include "harness/record/comparisons.h"
#include "harness/record/picture.h"
#include "harness/run/holm.h"

namespace assay::harness {
namespace {

/// A hash of the suite's text and its data, which all shards must share.
std::string digest_of(const SuiteRun& run) {
  std::uint64_t hash = text_hash(run.suite.text);
  for (const EstimatorEntry& entry : run.suite.estimators) {
    const auto prepared = run.estimators.find(entry.name);
    if (prepared == run.estimators.end()) continue;  // of a skipped suite
    if (const auto rows = recorded::observations_digest(*prepared->second.setup)) {
      hash = text_hash(fmt::format("{:016x}", *rows), hash);
      continue;
    }
    const std::string file = prepared->second.setup->data_file();
    if (file.empty()) continue;
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    hash = text_hash(text, hash);
  }
  return fmt::format("{:016x}", hash);
}

std::uint64_t position_of(const TestEntry& test, const Suite& suite) {
  return static_cast<std::uint64_t>(&test - suite.tests.data());
}

reports::ShardTest test_of(const TestOutcome& outcome, const SuiteRun& run) {
  const FamilyMember member = member_of(outcome);
  return {.position = position_of(*outcome.question.test, run.suite),
          .inside = outcome.place.inside,
          .weight = member.weight,
          .untested = member.untested,
          .log_p = member.log_p,
          .compared = compared_by(outcome.question)};
}

}  // namespace

void add_shard(const std::vector<std::unique_ptr<SuiteRun>>& runs, const RunOptions& options,
               reports::Record& record) {
  const auto [index, count] = *options.shard;
  reports::Shard shard{
      .index = index, .count = count, .options = options.command + options_text(options.selection)};
  for (const auto& run : runs) {
    reports::ShardSuite suite{.digest = digest_of(*run), .tests = run->suite.tests.size()};
    for (const Picture& picture : run->pictures) {
      suite.pictures.push_back(pictured(picture, *run).shown);
    }
    for (const TestWork& work : run->tests) suite.results.push_back(test_of(work.outcome, *run));
    for (const Untested& each : run->untested) {
      suite.results.push_back({.position = position_of(*each.test, run->suite)});
    }
    for (const Elsewhere& each : run->elsewhere) {
      suite.elsewhere.push_back({.shard = each.shard,
                                 .position = position_of(*each.test, run->suite),
                                 .id = each.test->id,
                                 .name = each.test->name,
                                 .claim = each.test->claim.text,
                                 .line = each.test->where.line});
    }
    // The record has its tests in this order.
    std::ranges::sort(suite.results, {}, &reports::ShardTest::position);
    shard.suites.push_back(std::move(suite));
  }
  record.shard = std::move(shard);
  record.note = fmt::format(
      "shard {} of {}: `assay merge` joins the records of all shards and adjusts their p-values by "
      "Holm's method",
      index, count);
}

}  // namespace assay::harness
