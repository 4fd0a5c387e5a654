#include "recorded/table.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "estimators/value.h"

namespace assay::recorded {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";

constexpr std::string_view stream_keyword = "stream:";

bool is_blank(char c) { return blanks.find(c) != blanks.npos; }

/// A piece of a line and the column it begins at, counted from 1.
struct Field {
  std::string_view text;
  int column;
};

Field trimmed(std::string_view line, std::size_t begin, std::size_t end) {
  while (begin < end && is_blank(line[begin])) ++begin;
  while (end > begin && is_blank(line[end - 1])) --end;
  return {line.substr(begin, end - begin), static_cast<int>(begin) + 1};
}

std::vector<Field> split_at_commas(std::string_view line) {
  std::vector<Field> fields;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line, begin, end));
    if (end == line.size()) return fields;
    begin = end + 1;
  }
}

std::vector<Field> split_at_blanks(std::string_view line) {
  std::vector<Field> fields;
  std::size_t begin = line.find_first_not_of(blanks);
  while (begin != line.npos) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    fields.push_back(trimmed(line, begin, end));
    begin = line.find_first_not_of(blanks, end);
  }
  return fields;
}

std::vector<Field> split(std::string_view line) {
  return line.find(',') != line.npos ? split_at_commas(line) : split_at_blanks(line);
}

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  void line(std::string_view text) {
    ++line_;
    const std::size_t comment = text.find('#');
    if (comment != text.npos) header(text, comment);
    const std::vector<Field> fields = split(text.substr(0, comment));
    if (fields.empty()) return;
    name_columns(fields.size());
    check_length(fields);
    for (const Field& field : fields) table_.values.push_back(number(field));
    table_.lines.push_back(line_);
  }

  Table finish() && {
    if (table_.values.empty()) {
      throw InputError({.file = file_}, "the file has no rows: write one observation a line");
    }
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(int column, const std::string& why) const {
    throw InputError({file_, line_, column}, why);
  }

  // A comment that begins with `columns:`.
  void header(std::string_view text, std::size_t comment) {
    const Field field = trimmed(text, comment + 1, text.size());
    if (field.text.starts_with(stream_keyword)) stream(field);
    constexpr std::string_view keyword = "columns:";
    if (!field.text.starts_with(keyword)) return;
    if (!table_.columns.empty()) {
      refuse(field.column, "`# columns:` must stand once, before the first row");
    }
    const auto skipped = static_cast<std::size_t>(field.column) - 1 + keyword.size();
    for (const Field& name : split(text.substr(skipped))) {
      add_name(name, static_cast<int>(skipped));
    }
    if (table_.columns.empty()) refuse(field.column, "`# columns:` names no column");
  }

  void stream(const Field& field) {
    const Field key = trimmed(field.text, stream_keyword.size(), field.text.size());
    std::uint64_t bits = 0;
    const char* const end = key.text.data() + key.text.size();
    const auto [stop, problem] = std::from_chars(key.text.data(), end, bits, 16);
    if (key.text.empty() || problem != std::errc{} || stop != end) {
      refuse(field.column,
             "`# stream:` needs a key of up to 16 hexadecimal digits, as `assay "
             "sample` writes it; leave the line out if there is none");
    }
    table_.stream = bits;
  }

  void add_name(const Field& name, int skipped) {
    if (name.text.empty()) refuse(skipped + name.column, "the name of a column is empty");
    if (std::ranges::find(table_.columns, name.text) != table_.columns.end()) {
      refuse(skipped + name.column,
             "there are two columns `" + std::string(name.text) + "`; give each its own name");
    }
    table_.columns.emplace_back(name.text);
  }

  void name_columns(std::size_t count) {
    if (!table_.columns.empty()) return;
    if (count == 1) table_.columns = {"value"};
    for (std::size_t i = 1; count > 1 && i <= count; ++i) {
      table_.columns.push_back("value" + std::to_string(i));
    }
  }

  void check_length(const std::vector<Field>& fields) const {
    const std::size_t expected = table_.columns.size();
    if (fields.size() == expected) return;
    const Field& at = fields[std::min(fields.size() - 1, expected)];
    refuse(at.column, "numbers in this row: " + std::to_string(fields.size()) + ", but columns: " +
                          std::to_string(expected) + "; every row needs the same number");
  }

  double number(const Field& field) const {
    std::string_view text = field.text;
    if (text.empty()) refuse(field.column, "a number is missing; write `nan` if there is none");
    // from_chars knows no plus sign; "+-1" stays junk.
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, value);
    const std::string quoted = "`" + std::string(field.text) + "`";
    if (problem == std::errc::result_out_of_range && stop == end) {
      refuse(field.column, quoted + " is beyond what a double can hold; write `inf` or 0 if meant");
    }
    if (problem != std::errc{} || stop != end) {
      refuse(field.column, quoted +
                               " is not a number; a comment or a header needs a leading `#` "
                               "(`# columns: a b`)");
    }
    return value;
  }

  std::string file_;
  int line_ = 0;
  Table table_;
};

}  // namespace

Table read_table(const std::string& file) {
  const auto refuse = [&](const std::string& why) {
    throw InputError({.file = file}, "it cannot be read: " + why);
  };
  // A stream opens a folder, and throws only when it is read.
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) refuse("it is a folder");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(errno != 0 ? std::strerror(errno) : "it does not open");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) refuse("reading it failed");
  Reader reader(file);
  std::string_view rest = text;
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    reader.line(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return std::move(reader).finish();
}

}  // namespace assay::recorded
