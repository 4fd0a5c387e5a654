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

/// Keeps freed memory in the process. Pictures allocate and free tens of megabytes, and new pages
/// from the system would cost more than the work on them.
void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

}  // namespace

Loaded loaded(const Command& command) {
  if (const auto* run = std::get_if<RunCommand>(&command)) {
    Loaded all{load_suites(run->suites, run->assignments), run->options};
    all.options.assigns = !run->assignments.empty();
    take_shard_from(system_environment, all.options);
    return all;
  }
  if (const auto* check = std::get_if<CheckCommand>(&command)) {
    return {{suite_of_claim(check->arguments)}, check->options};
  }
  if (const auto* images = std::get_if<ImagesCommand>(&command)) {
    keep_freed_memory();
    return {{suite_of_images(images->arguments)}, images->options};
  }
  refuse({}, "this command runs no test");
}

}  // namespace assay::harness
