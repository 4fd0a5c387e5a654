#include "harness/record/shard_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace assay::harness {
namespace {

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

}  // namespace

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

}  // namespace assay::harness
