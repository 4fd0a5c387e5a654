#include "harness/command/loaded.h"

#include <fmt/format.h>
#include <malloc.h>

#include <filesystem>
#include <map>

#include "harness/base/refuse.h"
#include "harness/command/environment.h"

namespace assay::harness {

std::vector<Suite> load_suites(const std::vector<std::string>& files,
                               const std::vector<std::string>& assignments) {
  std::vector<Suite> suites;
  std::map<std::string, std::string> files_of;  // by stem
  for (const std::string& file : files) {
    suites.push_back(load_suite(file));
    const auto [first, is_new] = files_of.emplace(suites.back().stem, file);
    if (is_new) continue;
    const std::string both = fmt::format("`{}` and `{}`", first->second, file);
    if (std::filesystem::equivalent(first->second, file)) {
      refuse({}, both + " are one suite; give it once");
    }
    refuse({},
           "{} are two suites whose tests have the ids `{}/…`; rename one of the files, or run "
           "each by itself",
           both, first->first);
  }
  for (const std::string& assignment : assignments) set_parameter(suites, assignment);
  return suites;
}

namespace {

Loaded run_of(const RunCommand& command) {
  Loaded all{load_suites(command.suites, command.assignments), command.options};
  all.options.assigns = !command.assignments.empty();
  take_shard_from(system_environment, all.options);
  return all;
}

Loaded run_of(const CheckCommand& command) {
  return {{suite_of_claim(command.arguments)}, command.options};
}

/// Keeps freed memory in the process. Pictures allocate and free tens of megabytes, and new pages
/// from the system would cost more than the work on them.
void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

Loaded run_of(const ImagesCommand& command) {
  keep_freed_memory();
  return {{suite_of_images(command.arguments)}, command.options};
}

}  // namespace

Loaded loaded(const Command& command) {
  if (const auto* run = std::get_if<RunCommand>(&command)) return run_of(*run);
  if (const auto* check = std::get_if<CheckCommand>(&command)) return run_of(*check);
  if (const auto* images = std::get_if<ImagesCommand>(&command)) return run_of(*images);
  refuse({}, "this command runs no test");
}

}  // namespace assay::harness
