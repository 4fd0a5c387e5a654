// suites/zoo.yaml against the catalogue: no mutant may be missing there, and none may survive every
// method.

#include "estimators/catalogue.h"
#include "harness/suite/suite.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

const Suite& zoo() {
  static const Suite suite = load_suite(std::string(ASSAY_SOURCE_DIR) + "/suites/zoo.yaml");
  return suite;
}

/// Plugins of the estimators that a claim names.
std::set<std::string> plugins_of(const Claim& claim) {
  std::set<std::string> plugins;
  for (const Source& source : sources_of(claim)) {
    for (const EstimatorEntry& entry : zoo().estimators) {
      if (entry.name == source.estimator) plugins.insert(entry.plugin);
    }
  }
  return plugins;
}

TEST(Zoo, KillsEveryMutantOfTheCatalogue) {
  std::set<std::string> killed;
  for (const TestEntry& test : zoo().tests) {
    if (test.expect == reports::Verdict::fail || test.expect == reports::Verdict::error) {
      killed.merge(plugins_of(test.claim));
    }
  }
  for (const Entry& entry : catalogue()) {
    if (entry.information.original.empty()) continue;
    EXPECT_TRUE(killed.contains(entry.information.name))
        << entry.information.name
        << " is a mutant, but no test of suites/zoo.yaml on it has `expect: fail`: add it there, "
           "with "
           "what each method sees of it";
  }
}

TEST(Zoo, TestsMutantsOnly) {
  for (const TestEntry& test : zoo().tests) {
    bool any = false;
    for (const std::string& plugin : plugins_of(test.claim)) {
      any = any || !find_plugin(plugin, test.where).information.original.empty();
    }
    EXPECT_TRUE(any) << test.name
                     << ": a sound estimator would be a family of its own here, and the "
                        "mutants' share of alpha with it";
  }
}

}  // namespace
}  // namespace assay::harness
