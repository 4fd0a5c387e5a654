#pragma once

// From suites to a record: pilot, plan, sampling, the family decision, verdicts.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/progress.h"
#include "harness/selection.h"
#include "harness/suite.h"
#include "reports/record.h"

namespace assay::harness {

struct RunOptions {
  std::optional<std::uint64_t> seed = {};                   ///< else the suite's, else 1
  unsigned threads = 0;                                     ///< 0: all cores
  std::optional<double> alpha = {};                         ///< instead of every suite's
  double coarsen = 1;                                       ///< multiplies every `detect`
  Selection selection = {};                                 ///< of tests; empty selects all
  std::optional<std::pair<unsigned, unsigned>> shard = {};  ///< I of N, I from 1
  bool shard_of_runner = false;  ///< a test runner's, for which a shard without tests is no mistake
  std::string ledger = "";       ///< file to add the evidence to; "": none
  std::string command = "";      ///< how to run the same again, for replay lines
};

/// Runs the selected tests of the suites. InputError for anything found wrong before sampling. A
/// ledger that cannot be written is a std::runtime_error, or is told in `ledger_fault`.
reports::Record run(const std::vector<Suite>& suites, const RunOptions& options, Progress& progress,
                    std::string* ledger_fault = nullptr);

enum class InconclusivePolicy { report, fail, pass };

/// 0 every test ok; 1 at least one not, or an alarm of the ledger; 3 nothing failed but something
/// is inconclusive; 4 nothing ran; 77 all skipped.
int exit_code(const reports::Record&, InconclusivePolicy);

}  // namespace assay::harness
