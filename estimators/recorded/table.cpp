#include "recorded/table.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "estimators/core/line_error.h"
#include "estimators/core/quoting.h"
#include "recorded/byte_source.h"
#include "recorded/fields.h"
#include "recorded/foreign_formats.h"
#include "recorded/npy.h"

namespace assay::recorded {

namespace {

constexpr std::string_view stream_keyword = "stream:";
constexpr std::size_t longest_line = std::size_t{64} << 20;

/// A field as a message shows it.
std::string in_message(std::string_view field) { return "`" + shown(field, 24) + "`"; }

std::vector<std::string> default_names(std::size_t count) {
  if (count == 1) return {"value"};
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= count; ++i) names.push_back("value" + std::to_string(i));
  return names;
}

class Reader {
 public:
  Reader(const ByteSource& source, std::size_t most, Rows expected)
      : source_(source), most_(most), expected_(expected) {}

  void line(std::string_view text) {
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (line_ < std::numeric_limits<int>::max()) ++line_;
    text_ = text;
    const std::string_view content = without_comment(text);
    if (content.size() < text.size()) comment(trimmed(text, content.size() + 1, text.size()));
    separator_ = separator_of(content);
    std::vector<Field> fields = split(content, separator_);
    if (fields.empty() || header(fields)) return;
    if (unnamed_rows_) fields.erase(fields.begin());
    if (table_.columns.empty()) table_.columns = default_names(fields.size());
    check_length(fields);
    if (table_.values.size() + fields.size() > most_) {
      throw InputError({.file = source_.name()}, "its numbers do not fit into memory");
    }
    for (const Field& field : fields) table_.values.push_back(number(field));
    if (table_.lines.empty()) first_separator_ = separator_;
    table_.lines.push_back(line_);
  }

  Table finish() && {
    const std::size_t columns = table_.columns.size();
    if (table_.values.empty()) {
      throw InputError({.file = source_.name()},
                       std::string(line_ == 0 ? "it is empty" : "it has no rows") +
                           ": write one observation a line");
    }
    const bool alone = table_.rows() == 1 && columns > 1 && !names_line_;
    if (alone && expected_ == Rows::several) refuse_one_row(columns);
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(int column, const std::string& why) const {
    // The beginning of a line without end will do.
    constexpr std::size_t most = std::size_t{1} << 20;
    throw LineError({source_.name(), line_, column}, why, text_.substr(0, most));
  }

  [[noreturn]] void refuse_one_row(std::size_t columns) const {
    const bool file = source_.name() != called("-");
    const std::string name = file ? " " + shell_quoted(source_.name()) : "";
    std::string command = source_.packed() ? "zcat" + name + " | " : "";
    command += std::string("tr -s '") +
               (first_separator_ == blank ? "" : std::string(1, first_separator_)) +
               " \\t\\r' '\\n'";
    if (first_separator_ == ';') command += " | tr , .";
    if (file) command += (source_.packed() ? "" : " <" + name) + std::string(" > lines.txt");
    throw InputError({.file = source_.name()},
                     "it is one row of " + std::to_string(columns) +
                         " numbers, and an observation is a row;\n  if each is an observation, "
                         "`" +
                         command + "`\n  writes one a line");
  }

  void comment(const Field& field) {
    constexpr std::string_view keyword = "columns:";
    if (field.text.starts_with(stream_keyword)) stream(field);
    if (!field.text.starts_with(keyword)) return;
    if (!table_.columns.empty()) {
      refuse(field.column, "`# columns:` must stand once, before the first row");
    }
    const auto skipped = static_cast<std::size_t>(field.column) - 1 + keyword.size();
    const std::size_t end = static_cast<std::size_t>(field.column) - 1 + field.text.size();
    const std::string_view names = text_.substr(skipped, end - skipped);
    add_names(split(names, separator_of(names)), static_cast<int>(skipped));
    if (table_.columns.empty()) refuse(field.column, "`# columns:` names no column");
  }

  /// True if a line is one of names. It takes them.
  bool header(const std::vector<Field>& fields) {
    if (!table_.columns.empty()) return false;
    const auto is_empty = [](const Field& field) {
      return field.text.empty() || field.text == "\"\"";
    };
    const bool rows_named = fields.size() > 1 && is_empty(fields[0]);
    const auto first = fields.begin() + (rows_named ? 1 : 0);
    const bool names = std::all_of(first, fields.end(), [&](const Field& field) {
      return !is_empty(field) && may_be_name(field);
    });
    if (!names) return false;
    unnamed_rows_ = rows_named;
    add_names({first, fields.end()}, 0);
    return true;
  }

  void stream(const Field& field) {
    const Field key = trimmed(field.text, stream_keyword.size(), field.text.size());
    std::uint64_t bits = 0;
    const char* const end = key.text.data() + key.text.size();
    const auto [stop, problem] = std::from_chars(key.text.data(), end, bits, 16);
    if (key.text.empty() || problem != std::errc{} || stop != end) {
      refuse(field.column,
             "`# stream:` needs a key of up to 16 hexadecimal digits,\n  as `assay sample` writes "
             "it; leave the line out if there is none");
    }
    table_.stream = bits;
  }

  void add_names(const std::vector<Field>& names, int skipped) {
    names_line_ = line_;
    std::set<std::string> seen;
    for (const Field& field : names) {
      const std::string name = unquoted(field.text);
      if (name.empty()) refuse(skipped + field.column, "the name of a column is empty");
      if (!seen.insert(name).second) {
        refuse(skipped + field.column,
               "there are two columns " + in_message(name) + "; give each its own name");
      }
      table_.columns.push_back(name);
    }
  }

  void check_length(const std::vector<Field>& fields) const {
    const std::size_t expected = table_.columns.size();
    if (fields.size() == expected) return;
    std::string why = "numbers in this row: " + std::to_string(fields.size()) +
                      ", but columns: " + std::to_string(expected);
    if (names_line_) why += " (named in line " + std::to_string(*names_line_) + ")";
    why += fields.size() == 2 * expected && separator_ == ','
               ? ";\n  write decimal points for commas, or `;` between the numbers"
               : ";\n  every row needs the same number";
    const int column = fields.empty() ? 1 : fields[std::min(fields.size() - 1, expected)].column;
    refuse(column, why);
  }

  double number(const Field& field) const {
    if (field.text.empty()) {
      refuse(field.column, "a number is missing; write `nan` if there is none");
    }
    const Parsed parsed = parse(field.text, separator_ == ';');
    if (parsed.is_number) return parsed.value;
    const std::string text = in_message(field.text);
    if (parsed.out_of_range) {
      refuse(field.column,
             text + " is beyond what a double can hold;\n  write `inf` or 0 if meant");
    }
    if (is_missing(field.text)) {
      refuse(field.column, text + " is not a number; write `nan` if there is none");
    }
    refuse(field.column,
           text +
               " is not a number;\n  a comment begins with `#`; names of columns stand in a first "
               "line\n  without numbers, or in `# columns: a b`");
  }

  const ByteSource& source_;
  std::size_t most_;
  Rows expected_;
  int line_ = 0;
  std::string_view text_;
  bool unnamed_rows_ = false;
  std::optional<int> names_line_;
  char separator_ = blank;  ///< of this line
  char first_separator_ = blank;
  Table table_;
};

/// Gives the lines of a text to a reader as they come.
class Lines {
 public:
  Lines(ByteSource& source, std::size_t most, Rows expected)
      : source_(source), reader_(source, most, expected) {}

  Table read() && {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (source_.look(byte_order_mark.size()).starts_with(byte_order_mark)) {
      source_.take(byte_order_mark.size());
    }
    std::string_view bytes = source_.look();
    for (; !bytes.empty(); bytes = source_.look()) {
      if (first_binary_byte(bytes) != bytes.npos) {
        throw InputError({.file = source_.name()}, no_text(bytes, source_.name()));
      }
      take_lines(bytes);
      source_.take(bytes.size());
    }
    if (!begun_.empty()) reader_.line(begun_);
    return std::move(reader_).finish();
  }

 private:
  void take_lines(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      if (end == bytes.npos || !begun_.empty()) begun_ += bytes.substr(0, end);
      if (begun_.size() > longest_line) {
        throw InputError({.file = source_.name()},
                         "a line of it has more than 64 MiB: write one observation a line");
      }
      if (end == bytes.npos) return;
      reader_.line(begun_.empty() ? bytes.substr(0, end) : begun_);
      begun_.clear();
      bytes.remove_prefix(end + 1);
    }
  }

  ByteSource& source_;
  Reader reader_;
  std::string begun_;  ///< a line of which the end has not come
};

/// A quarter of the memory, since a vector that grows takes thrice its size.
std::size_t most_numbers() {
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page = sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return std::numeric_limits<std::size_t>::max() / sizeof(double);
  return static_cast<std::size_t>(pages) * static_cast<std::size_t>(page) / 4 / sizeof(double);
}

Table table_of(Matrix matrix, const ByteSource& source, Rows expected) {
  if (expected == Rows::several && matrix.values.size() == matrix.columns && matrix.columns > 1) {
    throw InputError({.file = source.name()},
                     "it is one row of " + std::to_string(matrix.columns) +
                         " numbers, and an observation is a row;\n  if each is an observation, "
                         "save it with `numpy.save(\"mine.npy\", a.ravel())`");
  }
  return {.columns = default_names(matrix.columns), .values = std::move(matrix.values)};
}

}  // namespace

std::uint64_t Table::digest() const {
  std::uint64_t hash = 0;
  const auto add = [&](std::uint64_t bits) {
    // splitmix64's last step.
    hash = (hash ^ bits) + 0x9e3779b97f4a7c15U;
    hash = (hash ^ (hash >> 30U)) * 0xbf58476d1ce4e5b9U;
    hash = (hash ^ (hash >> 27U)) * 0x94d049bb133111ebU;
    hash ^= hash >> 31U;
  };
  for (const std::string& name : columns) {
    add(name.size());
    for (const char c : name) add(static_cast<unsigned char>(c));
  }
  for (const double value : values) add(std::bit_cast<std::uint64_t>(value));
  return hash;
}

Table read_table(const std::string& file, Rows expected) {
  ByteSource source(file);
  const std::size_t most = most_numbers();
  if (source.look(npy_magic.size()).starts_with(npy_magic)) {
    return table_of(read_npy(source, most), source, expected);
  }
  constexpr std::size_t beginning = 512;
  const std::string problem = no_text(source.look(beginning), source.name());
  if (!problem.empty()) throw InputError({.file = source.name()}, problem);
  return Lines(source, most, expected).read();
}

}  // namespace assay::recorded
