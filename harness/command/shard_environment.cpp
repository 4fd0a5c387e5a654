#include "harness/command/shard_environment.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>

#include "harness/suite/suite_keys.h"

namespace assay::harness {
namespace {

unsigned number(const Environment& environment, const std::string& name, std::uint64_t least) {
  const std::uint64_t value = count_from(Value::scalar(environment(name)), name, least);
  if (value >= std::numeric_limits<unsigned>::max()) {
    throw InputError({}, fmt::format("{} is too large", name));
  }
  return static_cast<unsigned>(value);
}

}  // namespace

void take_shard_from(const Environment& environment, RunOptions& options) {
  if (options.shard) return;
  for (const std::string prefix : {"GTEST_", "TEST_"}) {
    const std::string total_name = prefix + "TOTAL_SHARDS";
    const std::string index_name = prefix + "SHARD_INDEX";
    const bool has_total = !environment(total_name).empty();
    const bool has_index = !environment(index_name).empty();
    if (has_total != has_index) {
      throw InputError({}, fmt::format("{} is set and {} is not: set both, or neither",
                                       has_total ? total_name : index_name,
                                       has_total ? index_name : total_name));
    }
    if (has_total && !options.shard) {
      const unsigned total = number(environment, total_name, 1);
      const unsigned index = number(environment, index_name, 0);
      if (index >= total) {
        throw InputError({}, fmt::format("{} is {}, but of {} shards the last is {}", index_name,
                                         index, total, total - 1));
      }
      options.shard = {index + 1, total};
      options.shard_of_runner = true;
    }
    const std::string status = environment(prefix + "SHARD_STATUS_FILE");
    if (!status.empty() && !std::ofstream(status, std::ios::app)) {
      throw InputError({.file = status},
                       "the status file that the environment names cannot be written");
    }
  }
  if (options.shard && options.shard->second == 1) options.shard.reset();
}

}  // namespace assay::harness
