#pragma once

// `--ledger FILE`: the evidence of nights with fresh seeds, kept in a file, with an error budget of
// its own. One night misses a bias of its own standard error almost always; thirty do not.

#include <memory>
#include <string>
#include <vector>

#include "harness/record/record_of.h"
#include "reports/record/record.h"

namespace assay::harness {

/// InputError where a ledger could not be kept, before anything is sampled: it is there and cannot
/// be read, its folder is missing, or two suites could not be told apart in it.
void require_ledger(const std::string& file, const std::vector<Suite>& suites);

struct LedgerRun {
  std::string file;
  std::string date;  ///< when the run started, UTC, ISO 8601
  std::string commit;
};

/// Adds the evidence of every selected test inside its suite's family to the file, unless its seed
/// is there already, and says what all nights of these tests mean together: an alarm where E
/// reached 1 / (budget * the channel's weight in its suite * generation_share). The file is locked
/// while it is read and replaced.
reports::Ledger add_to_ledger(const LedgerRun& ledger,
                              const std::vector<std::unique_ptr<SuiteRun>>& runs);

}  // namespace assay::harness
