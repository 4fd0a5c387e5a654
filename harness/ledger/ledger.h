#pragma once

// `--ledger FILE`: keeps the evidence of nights with fresh seeds, with its own error budget. Many
// nights together find a bias that each one misses.

#include <memory>
#include <string>
#include <vector>

#include "harness/record/record_of.h"
#include "reports/record/record.h"

namespace assay::harness {

/// InputError, before anything is sampled, if a ledger could not be kept. Reasons are an unreadable
/// file, a missing folder, and two suites that the ledger could not tell apart.
void require_ledger(const std::string& file, const std::vector<Suite>& suites);

struct LedgerRun {
  std::string file;
  std::string date;  ///< start of the run, UTC, ISO 8601
  std::string commit;
};

/// Adds the evidence of every selected test inside its suite's family to the file, unless its seed
/// is there already. Returns what all nights of these tests mean together. An alarm is raised if E
/// reaches 1 / (budget * the channel's weight in its suite * generation_share). The file is locked
/// while it is read and replaced.
reports::Ledger add_to_ledger(const LedgerRun& ledger,
                              const std::vector<std::unique_ptr<SuiteRun>>& runs);

}  // namespace assay::harness
