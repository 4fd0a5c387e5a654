#include <fmt/format.h>

#include "estimators/catalogue.h"
#include "harness/commands.h"

namespace assay::harness {

int list_plugins() {
  for (const Entry& entry : catalogue()) fmt::print("{}\n", entry.information.name);
  return 0;
}

int list_tests(const std::vector<Suite>& suites) {
  for (const Suite& suite : suites) {
    for (const TestEntry& test : suite.tests) fmt::print("{}\n", test.id);
  }
  return 0;
}

}  // namespace assay::harness
