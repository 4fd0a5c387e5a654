#pragma once

// The statements of a suite: what somebody claims, answered by tests of the suite.

#include <vector>

#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

/// `statements:`. A name of `holds` or `fails` is that of a test, or a glob that matches names of
/// tests, in whose place these stand; no test stands twice. InputError at its place for a name that
/// no test has, for a test that shows nothing (it expects invalid or error), for one that would
/// show both, and for a condition without both lists, or both lists without a condition.
std::vector<StatementEntry> read_statements(const Document& document, const Value& list,
                                            const std::vector<TestEntry>& tests);

}  // namespace assay::harness
