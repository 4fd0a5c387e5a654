#include "harness/command/shard_environment.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>

#include "harness/command/cli_values.h"

namespace assay::harness {
namespace {

struct Variables {
  std::string total;
  std::string index;
  std::string status_file;
};

Variables variables(const std::string& prefix) {
  return {prefix + "TOTAL_SHARDS", prefix + "SHARD_INDEX", prefix + "SHARD_STATUS_FILE"};
}

unsigned number(const Environment& environment, const std::string& name, std::uint64_t least) {
  const std::uint64_t value = parse_count(environment(name), name.c_str(), least);
  if (value >= std::numeric_limits<unsigned>::max()) {
    throw InputError({}, fmt::format("{} is too large", name));
  }
  return static_cast<unsigned>(value);
}

void touch(const std::string& file) {
  if (!std::ofstream(file, std::ios::app)) {
    throw InputError({.file = file},
                     "the status file that the environment names cannot be written");
  }
}

}  // namespace

void take_shard_from(const Environment& environment, RunOptions& options) {
  if (options.shard) return;
  for (const char* prefix : {"GTEST_", "TEST_"}) {
    const Variables names = variables(prefix);
    const bool has_total = !environment(names.total).empty();
    const bool has_index = !environment(names.index).empty();
    if (has_total != has_index) {
      throw InputError({}, fmt::format("{} is set and {} is not: set both, or neither",
                                       has_total ? names.total : names.index,
                                       has_total ? names.index : names.total));
    }
    if (has_total && !options.shard) {
      const unsigned total = number(environment, names.total, 1);
      const unsigned index = number(environment, names.index, 0);
      if (index >= total) {
        throw InputError({}, fmt::format("{} is {}, but of {} shards the last is {}", names.index,
                                         index, total, total - 1));
      }
      options.shard = {index + 1, total};
      options.shard_of_runner = true;
    }
    const std::string status = environment(names.status_file);
    if (!status.empty()) touch(status);
  }
  if (options.shard && options.shard->second == 1) options.shard.reset();
}

}  // namespace assay::harness
