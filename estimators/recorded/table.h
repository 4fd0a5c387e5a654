#pragma once

// Numbers that another program wrote, as text.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace assay::recorded {

/// Rows of numbers, one a line of the file, with a name to each column.
struct Table {
  std::vector<std::string> columns;
  std::vector<double> values;                ///< row after row
  std::vector<int> lines = {};               ///< of the file, where the rows stand
  std::optional<std::uint64_t> stream = {};  ///< what `# stream: HEX` says the rows were drawn from

  std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
};

/// Reads a table. One row a line; numbers are separated by white space, or by commas where the line
/// has any; `#` begins a comment, empty lines are skipped. Names: `# columns: a b c` before the
/// first row, else `value` for one column and `value1`, `value2`, ... for more. `# stream: HEX`
/// tells the key of the stream the rows were drawn from. Numbers as in C++,
/// `inf` and `nan` included: a recorded failure is a value too.
/// InputError at line and column for a text that is not a number or no double can hold, an empty
/// field, a row of another length than the first or the header, a second or late or repeated
/// header, a file without rows, and at `file` when it cannot be read.
Table read_table(const std::string& file);

}  // namespace assay::recorded
