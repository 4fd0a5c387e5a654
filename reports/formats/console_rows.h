#pragma once

// The console's table of a suite's tests: laid out so that no number is ever cut. Not part of the
// public interface.

#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// One test as text, clean and without line feeds; no-break spaces keep numbers whole.
struct TestRow {
  std::string verdict;  ///< with its mark
  std::string name;
  std::string number;
  std::string cost;
};

/// Columns of a suite's table. If names have too little room, the cost goes first (width 0; the
/// suite's totals have it). Then the number moves below the name.
struct RowLayout {
  int verdict = 0;
  int name = 0;
  int number = 0;
  int cost = 0;
  bool number_below = false;
};

RowLayout layout_of(const std::vector<TestRow>& rows, int width);

/// The lines of one row, none wider than the width that the layout was made for.
std::vector<std::string> row_lines(const TestRow& row, const RowLayout& layout);

/// The confidence of most of a suite's intervals, as "99.98 %": it is said once, above the table.
std::string common_confidence(const Suite& suite);

/// The row of a test in a suite whose common confidence is given.
TestRow row_of(const Test& test, const std::string& common);

}  // namespace assay::reports
