#include "harness/base/record_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "estimators/core/quoting.h"
#include "harness/base/refuse.h"
#include "reports/report_formats.h"

namespace assay::harness {

reports::Record read_record(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    refuse({.file = file},
           "there is no such file; `--report json=FILE` saves a run that can be read");
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) refuse({.file = file}, "cannot be read; give a report of kind json");
  for (const char* extension : {".yaml", ".yml"}) {
    if (!file.ends_with(extension)) continue;
    refuse({.file = file},
           "this is no saved run but a suite, it seems: `assay run {} --report json=run.json` "
           "saves one",
           shell_quoted(file));
  }
  return reports::read_json(text.str(), file);
}

}  // namespace assay::harness
