#pragma once

#include <vector>

#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

/// Reads `statements:`. A member of `holds` or `fails` is a test's name, or a glob that its matches
/// replace; no test stands twice. InputError at its place for a name that no test has, and for a
/// test that expects invalid or error, which shows nothing. InputError also for a test in both
/// lists, a condition without both lists, and both lists without a condition.
std::vector<StatementEntry> read_statements(const Document& document, const Value& list,
                                            const std::vector<TestEntry>& tests);

}  // namespace assay::harness
