// Suite files (harness/suite.h). All bytes are a suite, or are refused at a place in the file.

// sources: harness/suite/suite.cpp
// sources: harness/suite/suite_from_command_line.cpp
// sources: harness/language/claim.cpp
// sources: harness/language/laws.cpp harness/suite/yaml.cpp harness/base/text_file.cpp
// sources: estimators/core/value.cpp estimators/core/value_checks.cpp estimators/core/flow.cpp
// sources: estimators/core/text_pattern.cpp estimators/catalogue.cpp estimators/parameters.cpp
// sources: estimators/estimator.cpp
// libraries: -lfmt -lyaml-cpp

#include <algorithm>

#include "estimators/estimator.h"
#include "harness/suite/suite.h"
#include "tests/fuzz/case.h"

namespace assay::plugins {

/// A suite is checked against names of plugins; nothing is prepared here, so that names will do.
std::vector<Entry> all() {
  const auto never = [](Parameters&) -> std::shared_ptr<const Setup> { std::abort(); };
  std::vector<Entry> entries(2);
  entries[0].information.name = "analytic/normal";
  entries[1].information.name = "luminaire/area";
  for (Entry& entry : entries) {
    entry.information.parameters = {{.name = "mean", .fallback = "0"},
                                    {.name = "scene", .type = ParameterType::string}};
    entry.prepare = never;
  }
  return entries;
}

}  // namespace assay::plugins

using namespace assay;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = fuzz::written(data, size, ".yaml");
  try {
    const harness::Suite suite = harness::load_suite(file);
    if (suite.tests.empty() || suite.estimators.empty()) std::abort();
  } catch (const InputError& error) {
    const auto lines = std::count(data, data + size, '\n') + 1;
    const bool inside = error.where().line >= 0 && error.where().line <= lines + 1;
    if (error.where().file != file || error.message().empty() || !inside) std::abort();
  }
  return 0;
}
