// Suite files (harness/suite.h). All bytes are a suite, or are refused at a place in the file.

#include <algorithm>

#include "harness/suite/suite.h"
#include "tests/fuzz/case.h"

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
