#include "harness/record/last_run.h"

#include <filesystem>

#include "harness/base/environment_variables.h"
#include "harness/base/terminal.h"
#include "harness/sampling/sample.h"
#include "reports/formats/json.h"
#include "reports/record/file.h"

namespace assay::harness {

std::string last_run_file() {
  std::string folder = system_environment("XDG_CACHE_HOME");
  const std::string home = system_environment("HOME");
  if (folder.empty() && !home.empty()) folder = home + "/.cache";
  return folder.empty() ? "" : folder + "/assay/last_run.json";
}

void keep_last_run(reports::Record record, bool says_failure) {
  const std::filesystem::path file = last_run_file();
  if (file.empty()) return;
  for (reports::Suite& suite : record.suites) {
    for (reports::Test& test : suite.tests) test.maps.clear();
  }
  try {
    std::filesystem::create_directories(file.parent_path());
    reports::write_whole(file, reports::compact_json(record));
  } catch (...) {
    if (says_failure) {
      say_beside_progress("the run is not kept for `assay explain`: " +
                          words_of(std::current_exception()));
    }
  }
}

}  // namespace assay::harness
