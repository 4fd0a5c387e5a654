#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <ranges>
#include <set>
#include <stdexcept>
#include <utility>

#include "harness/base/identity.h"
#include "harness/base/record_file.h"
#include "harness/base/text_file.h"
#include "harness/record/record_of.h"

namespace assay::harness {
namespace {

/// A hash of the suite's text and its data, which all shards must share.
std::string digest_of(const SuiteRun& run) {
  std::uint64_t hash = text_hash(run.suite.text);
  for (const EstimatorEntry& entry : run.suite.estimators) {
    const auto prepared = run.estimators.find(entry.name);
    if (prepared == run.estimators.end()) continue;  // of a skipped suite
    if (const auto rows = prepared->second.setup->data_digest()) {
      hash = text_hash(fmt::format("{:016x}", *rows), hash);
      continue;
    }
    const std::string file = prepared->second.setup->data_file();
    if (!file.empty()) hash = text_hash(bytes_of(file).value_or(""), hash);
  }
  return fmt::format("{:016x}", hash);
}

/// The numbers of the shards that are not there.
std::set<std::uint64_t> missing_of(const std::vector<ShardFile>& shards) {
  const auto all = std::views::iota(std::uint64_t{1}, shards.front().record.shard->count + 1);
  std::set<std::uint64_t> missing(all.begin(), all.end());
  for (const ShardFile& shard : shards) missing.erase(shard.record.shard->index);
  return missing;
}

/// The same in words; "" if all are there.
std::string missing_shards(const std::vector<ShardFile>& shards) {
  const std::uint64_t count = shards.front().record.shard->count;
  const std::set<std::uint64_t> missing = missing_of(shards);
  if (missing.empty()) return "";
  return fmt::format(
      "of {} shards these are missing, so their tests are skipped: {}; run them with --shard "
      "{}/{}{} and merge all records",
      count, fmt::join(missing, ", "), *missing.begin(), count, missing.size() > 1 ? ", …" : "");
}

std::vector<FamilyMember> parts_of(const std::vector<ShardFile>& shards, std::size_t suite) {
  std::vector<FamilyMember> parts;
  for (const ShardFile& shard : shards) {
    const std::vector<reports::Test>& tests = shard.record.suites[suite].tests;
    for (std::size_t i = 0; i < tests.size(); ++i) {
      parts.push_back({tests[i], shard.record.shard->suites[suite].results[i]});
    }
  }
  const std::set<std::uint64_t> missing = missing_of(shards);
  const reports::Record& any = shards.front().record;
  for (const reports::ShardElsewhere& test : any.shard->suites[suite].elsewhere) {
    if (!missing.contains(test.shard)) continue;
    parts.push_back(
        {{.name = test.name,
          .id = test.id,
          .claim = test.claim,
          .file = any.suites[suite].file,
          .line = test.line,
          .verdict = reports::Verdict::skipped,
          .message = fmt::format("shard {} of {} is missing", test.shard, any.shard->count)},
         {.position = test.position}});
  }
  std::ranges::sort(parts, {}, [](const FamilyMember& part) { return part.place.position; });
  return parts;
}

/// Adds what another shard has drawn of the suite. Each estimator's row is that of the shard that
/// drew most of it. A shard lacks the statements without one of its tests.
void add(const reports::Suite& more, reports::Suite& suite) {
  suite.timed = suite.timed || more.timed;
  suite.retries.insert(suite.retries.end(), more.retries.begin(), more.retries.end());
  for (const reports::EstimatorSummary& row : more.estimators) {
    const auto same =
        std::ranges::find(suite.estimators, row.name, &reports::EstimatorSummary::name);
    if (same != suite.estimators.end() && same->secondaries < row.secondaries) *same = row;
  }
  for (const reports::Statement& each : more.statements) {
    if (std::ranges::count(suite.statements, each) == 0) suite.statements.push_back(each);
  }
}

reports::Suite merge_suite(const std::vector<ShardFile>& shards, std::size_t index, bool& whole) {
  reports::Suite suite = shards.front().record.suites[index];
  for (const ShardFile& shard : shards | std::views::drop(1)) {
    add(shard.record.suites[index], suite);
  }
  std::ranges::stable_sort(suite.statements, {}, &reports::Statement::line);
  std::vector<FamilyMember> parts = parts_of(shards, index);
  const bool complete = parts.size() == shards.front().record.shard->suites[index].tests &&
                        missing_of(shards).empty();
  try {
    if (complete) adjust_p_values(parts);
  } catch (const std::domain_error& error) {
    refuse({},
           "the shards' parts of alpha do not fit together: {}; was a record edited? Run the "
           "shards again",
           error.what());
  }
  whole = whole && complete;
  suite.tests.clear();
  for (FamilyMember& part : parts) {
    // The file was beside the shard's record; a report that writes maps names it again.
    for (reports::Map& map : part.test.maps) map.file.clear();
    suite.tests.push_back(std::move(part.test));
  }
  return suite;
}

/// InputError if parts that belong together have different sizes, as after an edit by hand.
void check_whole(const ShardFile& shard) {
  const reports::Record& record = shard.record;
  if (!record.shard) {
    refuse({.file = shard.file},
           "is a whole run, not a shard; shards are made by `assay run … --shard I/N --report "
           "json=SHARD.json`");
  }
  const auto fits = [](const reports::FamilyResult& result, const reports::Test& test) {
    return result.log_p.size() == test.channels.size() && (!result.inside || result.weight > 0);
  };
  const bool sound =
      record.shard->index >= 1 && record.shard->index <= record.shard->count &&
      std::ranges::equal(record.shard->suites, record.suites,
                         [&](const reports::ShardSuite& part, const reports::Suite& suite) {
                           return std::ranges::equal(part.results, suite.tests, fits);
                         });
  if (!sound) {
    refuse({.file = shard.file},
           "its `shard` does not fit its tests: was it edited? Run the shard again");
  }
}

/// Joins what is told of each item by blanks.
template <class List, class Tell>
std::string all_of(const List& list, Tell tell) {
  return fmt::format("{}", fmt::join(list | std::views::transform(tell), " "));
}

/// Shards of one run have these names and values in common.
Identity identity_of(const reports::Record& record) {
  const auto rates = [](const reports::Suite& suite) {
    return fmt::format("{} {}", suite.alpha, suite.beta);
  };
  return {{"number of shards", std::to_string(record.shard->count)},
          {"version of the program", record.tool.version + " " + record.tool.commit},
          {"command", record.shard->options},
          {"seed", all_of(record.suites, &reports::Suite::seed)},
          {"alpha and beta", all_of(record.suites, rates)},
          {"suites and data", all_of(record.shard->suites, &reports::ShardSuite::digest)},
          {"compiler", record.environment.compiler},
          {"instruction set for rays", record.environment.isa}};
}

/// InputError unless the records are shards of one run, each at most once.
void check_shards(const std::vector<ShardFile>& shards) {
  std::map<std::uint64_t, std::string> seen;
  for (const ShardFile& shard : shards) {
    check_whole(shard);
    const Identity expected = identity_of(shards.front().record);
    if (const auto found = difference(identity_of(shard.record), expected)) {
      refuse({.file = shard.file},
             "belongs to another run than `{0}`: {1} `{2}` here, `{3}` there; run one of them "
             "again with the same {1}",
             shards.front().file, found->name, found->ours, found->theirs);
    }
    const std::uint64_t index = shard.record.shard->index;
    const auto [first, is_new] = seen.emplace(index, shard.file);
    if (is_new) continue;
    refuse({.file = shard.file}, "is shard {} of {}, and so is `{}`; give each shard once", index,
           shard.record.shard->count, first->second);
  }
}

}  // namespace

void add_shard(const SuiteRuns& runs, const RunOptions& options,
               std::vector<std::vector<reports::FamilyResult>> places, reports::Record& record) {
  const auto [index, count] = *options.shard;
  reports::Shard shard{
      .index = index, .count = count, .options = options.command + options_text(options.selection)};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    shard.suites.push_back({.digest = digest_of(*runs[i]),
                            .tests = runs[i]->suite.tests.size(),
                            .results = std::move(places[i]),
                            .elsewhere = runs[i]->elsewhere});
  }
  record.shard = std::move(shard);
  record.note = fmt::format(
      "shard {} of {}: `assay merge` joins the records of all shards and adjusts their p-values by "
      "Holm's method",
      index, count);
}

reports::Record merge(std::vector<ShardFile> shards) {
  check_shards(shards);
  std::ranges::sort(shards, {}, [](const ShardFile& each) { return each.record.shard->index; });
  reports::Record record = shards.front().record;
  record.shard.reset();
  record.suites.clear();
  record.seconds = 0;
  for (const ShardFile& shard : shards) {
    record.started = std::min(record.started, shard.record.started);
    record.seconds += shard.record.seconds;
    record.environment.threads =
        std::max(record.environment.threads, shard.record.environment.threads);
  }
  bool whole = true;
  for (std::size_t i = 0; i < shards.front().record.suites.size(); ++i) {
    record.suites.push_back(merge_suite(shards, i, whole));
  }
  record.note = whole ? "" : partial_note;
  if (const std::string missing = missing_shards(shards); !missing.empty()) record.note = missing;
  note_retries(record);
  return record;
}

int merge_shards(const std::vector<std::string>& records, const Output& output) {
  require_writable(output, records);
  std::vector<ShardFile> shards;
  for (const std::string& file : records) shards.push_back({file, read_record(file)});
  reports::Record record = merge(shards);
  const std::string missing = missing_shards(shards);
  Output told = output;
  told.tells_code = missing.empty();
  write_run(record, told);
  if (missing.empty()) return exit_code(record, output.inconclusive);
  fmt::print(stderr, "{}", in_lines(missing));
  return 1;
}

}  // namespace assay::harness
