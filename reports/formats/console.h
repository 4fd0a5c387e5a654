#pragma once

// The text for a terminal or a log. There is one writer, for a run under way and for a saved
// record.

#include <set>
#include <string>

#include "reports/record/record.h"

namespace assay::reports {

struct ConsoleOptions {
  bool colour = false;        ///< ANSI escape sequences.
  int width = 80;             ///< Columns of a line at most; below 40 counts as 40.
  int detail = 0;             ///< 0: a line a suite. 1: a line a test. 2: all numbers.
  std::uint64_t slowest = 0;  ///< Names so many of the slowest tests.
  std::string report = "";    ///< Path of a report that shows more; "": none.
};

/// The console of one run.
class Console {
 public:
  explicit Console(ConsoleOptions options) : options_(std::move(options)) {}

  /// A broken claim in 5 lines at most, and an empty line. It may be told before the run ends.
  std::string broken(const Suite&, const Test&);

  /// Suites, then claims that are not as they should be and were not told, then the verdict.
  std::string rest(const Record&) const;

 private:
  ConsoleOptions options_;
  std::set<std::string> told_ = {};  ///< Ids.
};

std::string console(const Record&, const ConsoleOptions& = {});

}  // namespace assay::reports
