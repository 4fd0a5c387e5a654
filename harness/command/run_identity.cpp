#include "harness/command/run_identity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>

#include "harness/base/text_hash.h"
#include "harness/record/record_of.h"
#include "harness/suite/files_read.h"

namespace assay::harness {
namespace {

std::string digest_of(const std::string& file) {
  std::string text(std::size_t{1} << 20, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  std::error_code ignored;
  return fmt::format("{:x} of {} bytes", text_hash(text),
                     std::filesystem::file_size(file, ignored));
}

}  // namespace

Identity identity_of(const std::vector<Suite>& suites, const RunOptions& options) {
  const reports::Tool tool = this_tool();
  const reports::Environment environment = this_environment(1);
  Identity identity{{"the version", fmt::format("{} ({})", tool.version, tool.commit)},
                    {"the compiler", environment.compiler},
                    {"the instruction set", environment.isa},
                    {"the seed", options.seed ? fmt::format("{}", *options.seed) : "the suite's"},
                    {"the command", options.command},
                    {"--filter", fmt::format("{}", options.selection.filters)},
                    {"--tag", fmt::format("{}", options.selection.tags)},
                    {"the shard", options.shard ? fmt::format("{}/{}", options.shard->first,
                                                              options.shard->second)
                                                : "the whole"},
                    {"--fail-fast", options.fail_fast ? "on" : "off"}};
  for (const std::string& file : files_read(suites)) {
    identity.emplace_back(fmt::format("the content of `{}`", file), digest_of(file));
  }
  return identity;
}

}  // namespace assay::harness
