#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::harness {

/// A test in its record.
struct Recorded {
  const reports::Suite& suite;
  const reports::Test& test;
};

/// The test with this id or name in the record of a file; `by_part` also accepts a part of an id
/// that no other test has. InputError if there is none or several, with suggestions.
Recorded find_test(const reports::Record& record, const std::string& file, const std::string& name,
                   bool by_part = false);

}  // namespace assay::harness
