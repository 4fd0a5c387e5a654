#pragma once

// Numbers that another program wrote, as text or as an array of numpy.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace assay::recorded {

/// Rows of numbers, with a name to each column.
struct Table {
  std::vector<std::string> columns;
  std::vector<double> values;                ///< row after row
  std::vector<int> lines = {};               ///< of a text, where the rows stand
  std::optional<std::uint64_t> stream = {};  ///< what `# stream: HEX` says the rows were drawn from

  std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
  /// Differs between tables of other names or numbers, unless someone made them to agree.
  std::uint64_t digest() const;
};

/// One row of several numbers may be several observations that someone wrote on one line.
enum class Rows { several, one_is_fine };

/// Reads a table from a file, a pipe, a device or, for `-`, standard input (ByteSource), compressed
/// by gzip or not. A file that begins like numpy's .npy is read by read_npy(), anything else as
/// text.
///
/// Text has one row a line. Numbers are separated by `;` where the line has any, else by commas,
/// else by tabs (one may end the line), else by white space. They are written as in C++, with `inf`
/// and `nan`. Where `;` separates, a comma is a decimal point. `"` may enclose a field. `#` begins
/// a comment, empty lines are skipped.
///
/// A first line in which nothing begins like a number names the columns, and so does
/// `# columns: a b c` before the first row. Else they are `value`, or `value1`, `value2`, …. A
/// first column without a name, or of words, holds the names of rows. It is left out. The line
/// `# stream: HEX` has the key of the stream that the rows were drawn from.
///
/// InputError with its line for a field that is empty, no number or beyond a double, and for a row
/// of another length. The same for a second, late or repeated header. InputError for a binary file,
/// for a file without rows, and for more numbers than a quarter of the memory holds. InputError for
/// one row of several numbers without names, if several rows are expected.
Table read_table(const std::string& file, Rows expected);

}  // namespace assay::recorded
