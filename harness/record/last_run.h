#pragma once

// The last run of the user, which `assay explain` reads.

#include <string>

#include "reports/record/record.h"

namespace assay::harness {

/// A file in $XDG_CACHE_HOME/assay, else in ~/.cache/assay; "" if there is no such folder to be.
std::string last_run_file();

/// Writes the record without its maps, whole or not at all. Nobody needs it to go on: a failure is
/// said only if asked.
void keep_last_run(reports::Record record, bool says_failure);

}  // namespace assay::harness
