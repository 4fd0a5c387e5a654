#include "harness/record/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "harness/base/numbers.h"
#include "harness/base/record_file.h"
#include "harness/record/comparisons.h"
#include "harness/record/record_of.h"
#include "harness/run/holm.h"

namespace assay::harness {
namespace {

using reports::Verdict;

std::set<std::uint64_t> indices_of(const std::vector<ShardFile>& shards) {
  std::set<std::uint64_t> indices;
  for (const ShardFile& shard : shards) indices.insert(shard.record.shard->index);
  return indices;
}

/// A shard's test with the data for Holm's method.
struct Part {
  reports::Test test;
  reports::ShardTest family;
};

std::vector<Part> parts_of(const std::vector<ShardFile>& shards, std::size_t suite) {
  std::vector<Part> parts;
  for (const ShardFile& shard : shards) {
    const std::vector<reports::Test>& tests = shard.record.suites[suite].tests;
    for (std::size_t i = 0; i < tests.size(); ++i) {
      parts.push_back({tests[i], shard.record.shard->suites[suite].results[i]});
    }
  }
  const std::set<std::uint64_t> there = indices_of(shards);
  const reports::Record& any = shards.front().record;
  for (const reports::ShardElsewhere& test : any.shard->suites[suite].elsewhere) {
    if (there.contains(test.shard)) continue;
    parts.push_back(
        {{.name = test.name,
          .id = test.id,
          .claim = test.claim,
          .file = any.suites[suite].file,
          .line = test.line,
          .verdict = Verdict::skipped,
          .message = fmt::format("shard {} of {} is missing", test.shard, any.shard->count)},
         {.position = test.position}});
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.family.position < b.family.position; });
  return parts;
}

void adjust_p_values(std::vector<Part>& parts) {
  std::vector<FamilyMember> family;
  std::vector<Part*> owners;
  for (Part& part : parts) {
    if (!part.family.inside) continue;
    family.push_back({.verdict = part.test.verdict,
                      .weight = part.family.weight,
                      .untested = part.family.untested,
                      .log_p = part.family.log_p});
    owners.push_back(&part);
  }
  try {
    adjust_family(family);
  } catch (const std::domain_error& error) {
    throw InputError({}, fmt::format("the shards' shares of alpha do not fit together: {}; was a "
                                     "record edited? Run the shards again",
                                     error.what()));
  }
  for (std::size_t k = 0; k < family.size(); ++k) {
    std::vector<reports::Channel>& channels = owners[k]->test.channels;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      channels[i].p_adjusted = probability(family[k].log_p_adjusted[i]);
      channels[i].log10_p_adjusted = log10_of(family[k].log_p_adjusted[i]);
    }
  }
}

struct View {
  const reports::EstimatorSummary* row;
  const reports::ShardPicture* picture;

  /// A run shows the test that drew most of the estimator. It shows a draw for the picture alone
  /// only if no test draws it.
  bool shows_less_than(const View& other) const {
    return std::pair(picture->by_tests, picture->secondaries) <
           std::pair(other.picture->by_tests, other.picture->secondaries);
  }
};

/// The view of each estimator that one run would have, in the suite's order.
std::vector<View> views_of(const std::vector<ShardFile>& shards, std::size_t suite) {
  std::vector<View> best;
  for (const ShardFile& shard : shards) {
    const std::vector<reports::EstimatorSummary>& rows = shard.record.suites[suite].estimators;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const View view{&rows[i], &shard.record.shard->suites[suite].pictures[i]};
      const auto at = std::lower_bound(best.begin(), best.end(), view, [](const View& a, View b) {
        return a.picture->position < b.picture->position;
      });
      if (at == best.end() || at->picture->position != view.picture->position) {
        best.insert(at, view);
      } else if (at->shows_less_than(view)) {
        *at = view;
      }
    }
  }
  return best;
}

/// The statements of all shards, each once, in the suite's order. A shard lacks those without one
/// of its tests.
std::vector<reports::Statement> statements_of(const std::vector<ShardFile>& shards,
                                              std::size_t suite) {
  std::map<std::pair<int, std::string>, reports::Statement> by_line;
  for (const ShardFile& shard : shards) {
    for (const reports::Statement& statement : shard.record.suites[suite].statements) {
      by_line.emplace(std::pair(statement.line, statement.text), statement);
    }
  }
  std::vector<reports::Statement> all;
  for (auto& [place, statement] : by_line) all.push_back(std::move(statement));
  return all;
}

reports::Suite merge_suite(const std::vector<ShardFile>& shards, std::size_t index, bool& whole) {
  reports::Suite suite = shards.front().record.suites[index];
  suite.estimators.clear();
  suite.tests.clear();
  suite.retries.clear();
  for (const ShardFile& shard : shards) {
    const std::vector<reports::Retry>& more = shard.record.suites[index].retries;
    suite.retries.insert(suite.retries.end(), more.begin(), more.end());
  }
  suite.timed = std::any_of(shards.begin(), shards.end(), [&](const ShardFile& shard) {
    return shard.record.suites[index].timed;
  });
  std::vector<Part> parts = parts_of(shards, index);
  const bool complete = parts.size() == shards.front().record.shard->suites[index].tests &&
                        missing_shards(shards).empty();
  if (complete) adjust_p_values(parts);
  whole = whole && complete;
  std::vector<Pictured> pictures;
  for (const View& view : views_of(shards, index)) {
    suite.estimators.push_back(*view.row);
    pictures.push_back({view.row->name, view.row->variance_of == "primary", *view.picture});
  }
  std::vector<std::vector<std::string>> compared;
  for (Part& part : parts) {
    compared.push_back(part.family.compared);
    // The file was beside the shard's record; a report that writes maps names it again.
    for (reports::Map& map : part.test.maps) map.file.clear();
    suite.tests.push_back(std::move(part.test));
  }
  suite.comparisons = comparisons(pictures, compared, suite.alpha);
  suite.statements = statements_of(shards, index);
  return suite;
}

[[noreturn]] void refuse(const ShardFile& shard, const std::string& why) {
  throw InputError({.file = shard.file}, why);
}

/// InputError if parts that belong together have different sizes, as after an edit by hand.
void check_whole(const ShardFile& shard) {
  const reports::Record& record = shard.record;
  if (!record.shard) {
    refuse(shard,
           "is a whole run, not a shard; shards are made by `assay run … --shard I/N "
           "--report json=SHARD.json`");
  }
  bool sound = record.shard->index >= 1 && record.shard->index <= record.shard->count &&
               record.shard->suites.size() == record.suites.size();
  for (std::size_t i = 0; sound && i < record.suites.size(); ++i) {
    const reports::Suite& suite = record.suites[i];
    const reports::ShardSuite& part = record.shard->suites[i];
    sound = part.pictures.size() == suite.estimators.size() &&
            part.results.size() == suite.tests.size();
    for (std::size_t k = 0; sound && k < suite.tests.size(); ++k) {
      const reports::ShardTest& result = part.results[k];
      const std::size_t channels = suite.tests[k].channels.size();
      sound = result.log_p.size() == channels && (!result.inside || result.weight > 0);
    }
  }
  if (!sound)
    refuse(shard, "its `shard` does not fit its tests: was it edited? Run the shard again");
}

struct Property {
  const char* name;
  std::string (*of)(const reports::Record&);
  const char* mend;
};

std::string seeds(const reports::Record& record) {
  std::string text;
  for (const reports::Suite& suite : record.suites) text += fmt::format(" {}", suite.seed);
  return text.substr(text.empty() ? 0 : 1);
}

std::string digests(const reports::Record& record) {
  std::string text;
  for (const reports::ShardSuite& suite : record.shard->suites) text += " " + suite.digest;
  return text.substr(text.empty() ? 0 : 1);
}

std::string alphas(const reports::Record& record) {
  std::string text;
  for (const reports::Suite& suite : record.suites) {
    text += fmt::format(" {} {}", suite.alpha, suite.beta);
  }
  return text.substr(text.empty() ? 0 : 1);
}

const Property properties[] = {
    {"the number of shards",
     [](const reports::Record& r) { return std::to_string(r.shard->count); },
     "run all of them as --shard I/N with one N"},
    {"the program's version",
     [](const reports::Record& r) { return r.tool.version + " " + r.tool.commit; },
     "run all shards by one version of assay"},
    {"the options", [](const reports::Record& r) { return r.shard->options; },
     "run all shards by one command, but for --shard and --report"},
    {"the seed", seeds, "give all shards one --seed"},
    {"alpha and beta", alphas, "run all shards with one --alpha"},
    {"the digest of the suites and the data they name", digests,
     "run all shards on the same files"},
    {"the compiler", [](const reports::Record& r) { return r.environment.compiler; },
     "run all shards by one build"},
    {"the instruction set that rays are traced with",
     [](const reports::Record& r) { return r.environment.isa; },
     "run all shards on machines of one kind"}};

void check_same(const ShardFile& first, const ShardFile& other) {
  for (const Property& property : properties) {
    const std::string here = property.of(other.record);
    const std::string there = property.of(first.record);
    if (here == there) continue;
    refuse(other, fmt::format("is no part of the run that `{}` is of: {} is `{}` here and `{}` "
                              "there; {}",
                              first.file, property.name, here, there, property.mend));
  }
}

/// InputError unless the records are shards of one run, each at most once.
void check_shards(const std::vector<ShardFile>& shards) {
  std::map<std::uint64_t, std::string> seen;
  for (const ShardFile& shard : shards) {
    check_whole(shard);
    check_same(shards.front(), shard);
    const std::uint64_t index = shard.record.shard->index;
    const auto [first, is_new] = seen.emplace(index, shard.file);
    if (is_new) continue;
    refuse(shard, fmt::format("is shard {} of {}, and so is `{}`; give each shard once", index,
                              shard.record.shard->count, first->second));
  }
}

}  // namespace

std::string missing_shards(const std::vector<ShardFile>& shards) {
  const std::set<std::uint64_t> there = indices_of(shards);
  const std::uint64_t count = shards.front().record.shard->count;
  std::vector<std::uint64_t> missing;
  for (std::uint64_t index = 1; index <= count; ++index) {
    if (!there.contains(index)) missing.push_back(index);
  }
  if (missing.empty()) return "";
  return fmt::format(
      "of {} shards these are missing, and their tests are skipped: {}; run them with --shard "
      "{}/{}{} "
      "and merge all records",
      count, fmt::join(missing, ", "), missing.front(), count, missing.size() > 1 ? ", …" : "");
}

reports::Record merge(std::vector<ShardFile> shards) {
  check_shards(shards);
  std::sort(shards.begin(), shards.end(), [](const ShardFile& a, const ShardFile& b) {
    return a.record.shard->index < b.record.shard->index;
  });
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

int merge_shards(const MergeArguments& arguments, const Output& output) {
  require_writable(output, arguments.records);
  std::vector<ShardFile> shards;
  for (const std::string& file : arguments.records) shards.push_back({file, read_record(file)});
  reports::Record record = merge(shards);
  RunReports(output).write_and_annotate(record);
  const std::string missing = missing_shards(shards);
  if (missing.empty()) return exit_code(record, output.inconclusive);
  fmt::print(stderr, "assay: {}\n", missing);
  return 1;
}

}  // namespace assay::harness
