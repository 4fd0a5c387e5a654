#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::harness {

/// Reads a saved run. InputError if the file cannot be read, reports::ReadError if it is no record.
reports::Record read_record(const std::string& file);

/// A test in its record.
struct Recorded {
  const reports::Suite& suite;
  const reports::Test& test;
};

/// The name of the last run from this folder in place of a file's.
inline const std::string the_last_run = "the last run";

/// The test with this id, part of an id or name in the record of a file. Without a name it is the
/// one that is not as it should be. InputError if there is none or several, with suggestions.
Recorded find_test(const reports::Record& record, const std::string& file, const std::string& name);

}  // namespace assay::harness
