#include "recorded/table.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "estimators/core/mapped.h"
#include "estimators/core/quoting.h"
#include "estimators/ready_made.h"
#include "recorded/byte_source.h"
#include "recorded/npy.h"

namespace assay::recorded {

namespace {

/// The separator if there is no other: white space of any length.
inline constexpr char blank = ' ';

/// A piece of a line and the column it begins at, counted from 1.
struct Field {
  std::string_view text;
  int column;
};

constexpr std::string_view blanks = " \t\r\f\v";

bool is_blank(char c) { return blanks.find(c) != blanks.npos; }

/// Calls `visit(i)` for each character outside of quotes until it says true.
template <class Visit>
void outside_quotes(std::string_view line, const Visit& visit) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (!quoted && visit(i)) return;
  }
}

bool is_quoted(std::string_view text) {
  return text.size() > 1 && text.front() == '"' && text.back() == '"';
}

/// Returns the bytes from `begin` to before `end` without the white space around them.
Field trimmed(std::string_view line, std::size_t begin, std::size_t end) {
  while (begin < end && is_blank(line[begin])) ++begin;
  while (end > begin && is_blank(line[end - 1])) --end;
  return {line.substr(begin, end - begin), static_cast<int>(begin) + 1};
}

/// Returns the line without its comment. A comment begins where a field could, so that `1.#INF` has
/// none.
std::string_view without_comment(std::string_view line) {
  constexpr std::string_view separators = " \t\r\f\v;,";
  std::size_t end = line.size();
  outside_quotes(line, [&](std::size_t i) {
    const bool begins = i == 0 || separators.find(line[i - 1]) != separators.npos;
    if (line[i] == '#' && begins) end = i;
    return end < line.size();
  });
  return line.substr(0, end);
}

/// Returns what separates the fields of a line: `;`, else `,`, else a tab, else `blank`. Separators
/// within quotes do not count, here as in split().
char separator_of(std::string_view line) {
  constexpr std::string_view kinds = ";,\t";
  std::size_t first = kinds.size();
  outside_quotes(line, [&](std::size_t i) {
    first = std::min(first, kinds.find(line[i]));
    return first == 0;
  });
  return first < kinds.size() ? kinds[first] : blank;
}

/// Returns the fields of a line; none where it is empty. A tab at its end is no separator.
std::vector<Field> split(std::string_view line, char separator) {
  const std::size_t last = line.find_last_not_of(blanks);
  if (last == line.npos) return {};
  line = line.substr(0, last + 1);
  std::vector<Field> fields;
  std::size_t begin = 0;
  const auto add = [&](std::size_t end) {
    const Field field = trimmed(line, begin, end);
    if (separator != blank || !field.text.empty()) fields.push_back(field);
    begin = end + 1;
  };
  outside_quotes(line, [&](std::size_t i) {
    if (separator == blank ? is_blank(line[i]) : line[i] == separator) add(i);
    return false;
  });
  add(line.size());
  return fields;
}

/// Returns the text between quotes, a doubled one for one.
std::string unquoted(std::string_view text) {
  if (!is_quoted(text)) return std::string(text);
  std::string inside;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    inside += text[i];
    if (text[i] == '"') ++i;
  }
  return inside;
}

/// The number that a text is, if it is one.
struct Parsed {
  double value = 0;
  bool is_number = false;
  bool out_of_range = false;
};

/// Reads a number as C++ writes it, also in quotes. With `decimal_comma` a comma may be its point.
Parsed parse(std::string_view text, bool decimal_comma) {
  if (is_quoted(text)) text = text.substr(1, text.size() - 2);
  std::string pointed;
  if (decimal_comma && text.find('.') == text.npos && std::ranges::count(text, ',') == 1) {
    pointed = text;
    pointed[pointed.find(',')] = '.';
    text = pointed;
  }
  // from_chars knows no plus sign; "+-1" stays junk.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Parsed parsed;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, parsed.value);
  parsed.is_number = problem == std::errc{} && stop == end;
  parsed.out_of_range = problem == std::errc::result_out_of_range && stop == end;
  return parsed;
}

/// Tells whether a program wrote that a number is missing.
bool is_missing(std::string_view text) {
  constexpr std::array words{"NA", "N/A", "n/a", "<NA>", "null", "NULL", "None", "-"};
  return std::ranges::find(words, text) != words.end();
}

/// Tells whether a field of a first line may name a column: nothing that was meant as a number.
bool may_be_name(const Field& field) {
  const bool numeric = std::string_view("0123456789+-.").find(field.text[0]) != std::string::npos;
  return !numeric && !is_missing(field.text) && !parse(field.text, false).is_number &&
         (field.text[0] != '"' || is_quoted(field.text));
}

bool is_word(const Field& field) { return !field.text.empty() && may_be_name(field); }

using namespace std::string_view_literals;

struct Format {
  std::string_view magic;
  std::string_view what;         ///< Follows "it is a binary file, not text: ".
  std::string_view mend;         ///< A shell's name of the file replaces $, Python's name @.
  std::string_view filter = "";  ///< A command that turns its input into text.
};

constexpr std::string_view as_exr =
    "a mean of pixels needs unrounded numbers: render to OpenEXR (.exr)";

constexpr std::string_view as_file =
    "name the file of the picture itself: a picture cannot come from a pipe or an archive";

constexpr std::array formats{
    Format{"\x76\x2f\x31\x01"sv, "an OpenEXR picture", as_file},
    Format{"\x89PNG"sv, "a PNG picture", as_file},
    Format{"PF\n"sv, "a PFM picture", as_file},
    Format{"\xff\xd8\xff"sv, "a JPEG picture", as_exr},
    Format{"II*\0"sv, "a TIFF picture", as_exr},
    Format{"MM\0*"sv, "a TIFF picture", as_exr},
    Format{"#?RADIANCE"sv, "a Radiance picture", as_exr},
    Format{"PK\x03\x04"sv, "a zip archive, as .npz and .xlsx are",
           "`unzip $` gives the arrays of an .npz as .npy files, which can be read; "
           "save a spreadsheet as CSV"},
    Format{"\x89HDF\r\n\x1a\n"sv, "HDF5",
           "in Python `numpy.save(\"mine.npy\", h5py.File(@)[\"NAME\"][:])`"},
    Format{"MATLAB 5.0 MAT-file"sv, "MATLAB's .mat",
           "in MATLAB `writematrix(x, 'mine.csv')`, x being the matrix"},
    Format{"PAR1"sv, "Parquet", "in Python `pandas.read_parquet(@).to_csv(\"mine.csv\")`"},
    Format{"SQLite format 3"sv, "an SQLite database",
           "`sqlite3 -csv -header $ 'select x from t' > mine.csv`"},
    Format{"\x28\xb5\x2f\xfd"sv, "compressed by zstd",
           "`zstd -dc $ | assay …` with `file=-`, or compress by gzip", "zstd -dc"},
    Format{"\xfd\x37zXZ\0"sv, "compressed by xz",
           "`xz -dc $ | assay …` with `file=-`, or compress by gzip", "xz -dc"},
    Format{"BZh"sv, "compressed by bzip2",
           "`bzip2 -dc $ | assay …` with `file=-`, or compress by gzip", "bzip2 -dc"},
    Format{"\x7f"
           "ELF"sv,
           "a program", "let it write into a pipe: `PROGRAM | assay …` with `file=-`"},
    Format{"\xff\xfe"sv, "UTF-16, as PowerShell and Excel write it",
           "`iconv -f UTF-16 -t UTF-8 $ > mine.txt` makes text of it", "iconv -f UTF-16 -t UTF-8"},
    Format{"\xfe\xff"sv, "UTF-16", "`iconv -f UTF-16 -t UTF-8 $ > mine.txt` makes text of it",
           "iconv -f UTF-16 -t UTF-8"},
};

/// The name of a file in a line to paste. Only its user knows what a pipe came from.
std::string to_paste(const std::string& file) {
  return file == called("-") || is_read_once(file) ? "FILE" : file;
}

std::string mend_of(const Format& format, const std::string& file) {
  if (file == called("-") && !format.filter.empty()) {
    return "put `" + std::string(format.filter) + " |` before `assay`";
  }
  std::string mend(format.mend);
  const std::size_t place = mend.find_first_of("$@");
  if (place == mend.npos) return mend;
  const std::string name = to_paste(file);
  return mend.replace(place, 1, mend[place] == '$' ? shell_quoted(name) : python_quoted(name));
}

/// Returns the place of the first byte that no text has, npos where there is none. Escapes of
/// terminals count as text.
std::size_t first_binary_byte(std::string_view bytes) {
  const auto binary = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    constexpr unsigned char escape = 0x1b;
    return (byte < 0x20 && (byte < '\b' || byte > '\r') && byte != escape) || byte == 0x7f;
  };
  const auto found = std::ranges::find_if(bytes, binary);
  return found == bytes.end() ? bytes.npos : static_cast<std::size_t>(found - bytes.begin());
}

/// Names the format of a binary file by its first bytes, and says how to come to numbers. Returns
/// "" for what may be text. `file` is its name, as called() says it.
std::string no_text(std::string_view beginning, const std::string& file) {
  const bool text = first_binary_byte(beginning) == beginning.npos;
  for (const Format& format : formats) {
    if (!beginning.starts_with(format.magic)) continue;
    // A text may begin by chance as a picture does: `PF`, `BZh`.
    const bool printable = first_binary_byte(format.magic) == format.magic.npos &&
                           static_cast<unsigned char>(format.magic[0]) < 0x80;
    if (printable && text) continue;
    return "it is a binary file, not text: " + std::string(format.what) + "; " +
           mend_of(format, file);
  }
  if (text) return "";
  return "it is a binary file, not text; write the numbers as text, an observation a line, "
         "or as .npy, from raw doubles in Python: `numpy.save(\"mine.npy\", numpy.fromfile(" +
         python_quoted(to_paste(file)) + "))`";
}

constexpr const char* missing_by_chance =
    "; leave its row out if it is missing by chance, or write `nan` in a column that no claim "
    "reads";

constexpr const char* mend_of_comma =
    ": write `.` for it, and no comma between thousands; if these are columns, name them in a "
    "first line";
constexpr std::string_view stream_keyword = "stream:";
constexpr std::size_t longest_line = std::size_t{64} << 20;

/// A field as a message shows it.
std::string in_message(std::string_view field) { return "`" + shown(field, 24) + "`"; }

std::vector<std::string> default_names(std::size_t count) {
  if (count == 1) return {"value"};
  return mapped_indices(count, [](std::size_t i) { return "value" + std::to_string(i + 1); });
}

bool is_whole(std::string_view text) {
  return text.find_first_not_of("0123456789", text.starts_with('-') ? 1 : 0) == text.npos;
}

/// `3,14`, which may be one number.
bool may_be_a_decimal(const std::vector<Field>& fields, char separator) {
  return separator == ',' && fields.size() == 2 && is_whole(fields[0].text) &&
         is_whole(fields[1].text) && !fields[1].text.starts_with('-') &&
         fields[1].column == fields[0].column + static_cast<int>(fields[0].text.size()) + 1;
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
    if (names_rows(fields)) {
      rows_named_ = words_first_ = true;
      table_.columns.erase(table_.columns.begin());
    }
    if (words_first_ && !is_word(fields[0])) {
      refuse(fields[0].column, in_message(fields[0].text) +
                                   " stands where an earlier row has a word, which would name "
                                   "it; write numbers in all rows, or words");
    }
    if (rows_named_) fields.erase(fields.begin());
    if (table_.columns.empty()) table_.columns = default_names(fields.size());
    check_length(fields);
    may_be_decimals_ = may_be_decimals_ && may_be_a_decimal(fields, separator_);
    if (table_.values.size() + fields.size() > most_) {
      source_.refuse("its numbers do not fit into memory");
    }
    for (const Field& field : fields) table_.values.push_back(number(field));
    if (table_.lines.empty()) first_separator_ = separator_;
    table_.lines.push_back(line_);
  }

  Table finish() && {
    const std::size_t columns = table_.columns.size();
    if (table_.values.empty()) {
      source_.refuse(std::string(line_ == 0 ? "it is empty" : "it has no rows") +
                     ": write one observation a line");
    }
    const bool alone = table_.rows() == 1 && columns > 1 && !names_line_;
    if (alone && expected_ == Rows::several) refuse_one_row(columns);
    if (may_be_decimals_ && !names_line_ && expected_ == Rows::several) {
      throw InputError({.file = source_.name(), .line = table_.lines.front(), .column = 1},
                       std::string("a comma may be a decimal point") + mend_of_comma);
    }
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(int column, const std::string& why) const {
    // The beginning of a line without end will do.
    constexpr std::size_t most = std::size_t{1} << 20;
    throw InputError({source_.name(), line_, column}, why, std::string(text_.substr(0, most)));
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
    source_.refuse("it is one row of " + std::to_string(columns) +
                   " numbers, and an observation is a row; if each is an observation, `" + command +
                   "` writes one a line");
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
    rows_named_ = rows_named;
    add_names({first, fields.end()}, 0);
    return true;
  }

  /// True of a first row that begins with a word, and has no other.
  bool names_rows(const std::vector<Field>& fields) const {
    return !rows_named_ && names_line_ && table_.lines.empty() && fields.size() > 1 &&
           fields.size() == table_.columns.size() && is_word(fields[0]) &&
           std::none_of(fields.begin() + 1, fields.end(), is_word);
  }

  void stream(const Field& field) {
    const Field key = trimmed(field.text, stream_keyword.size(), field.text.size());
    table_.stream = read_as<std::uint64_t>(key.text, 16);
    if (!table_.stream) {
      refuse(field.column,
             "`# stream:` needs a key of up to 16 hexadecimal digits, as `assay sample` writes "
             "it; leave the line out if there is none");
    }
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
               ? "; write decimal points for commas, or `;` between the numbers"
               : "; every row needs the same number";
    const int column = fields.empty() ? 1 : fields[std::min(fields.size() - 1, expected)].column;
    refuse(column, why);
  }

  double number(const Field& field) const {
    if (field.text.empty()) {
      refuse(field.column, std::string("a number is missing") + missing_by_chance);
    }
    const bool is_fraction = separator_ == ',' && field.text.size() > 1 && field.text[0] == '0' &&
                             '0' <= field.text[1] && field.text[1] <= '9';
    if (is_fraction && !names_line_) {
      refuse(field.column, in_message(field.text) + " follows a comma" + mend_of_comma);
    }
    const Parsed parsed = parse(field.text, separator_ == ';');
    if (parsed.is_number) return parsed.value;
    const std::string text = in_message(field.text);
    if (parsed.out_of_range) {
      refuse(field.column, text + " is beyond what a double can hold; write `inf` or 0 if meant");
    }
    if (is_missing(field.text)) refuse(field.column, text + " is not a number" + missing_by_chance);
    refuse(field.column,
           text +
               " is not a number; a comment begins with `#`; names of columns stand in a first "
               "line without numbers, or in `# columns: a b`");
  }

  const ByteSource& source_;
  std::size_t most_;
  Rows expected_;
  int line_ = 0;
  std::string_view text_;
  bool rows_named_ = false;
  bool words_first_ = false;  ///< The first column has words.
  bool may_be_decimals_ = true;
  std::optional<int> names_line_;
  char separator_ = blank;  ///< of this line
  char first_separator_ = blank;
  Table table_;
};

/// Gives the lines of a text to a reader as they come.
Table read_text(ByteSource& source, std::size_t most, Rows expected) {
  Reader reader(source, most, expected);
  std::string begun;  // a line of which the end has not come
  const auto take_lines = [&](std::string_view bytes) {
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      if (end == bytes.npos || !begun.empty()) begun += bytes.substr(0, end);
      if (begun.size() > longest_line) {
        source.refuse("a line of it has more than 64 MiB: write one observation a line");
      }
      if (end == bytes.npos) return;
      reader.line(begun.empty() ? bytes.substr(0, end) : begun);
      begun.clear();
      bytes.remove_prefix(end + 1);
    }
  };
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (source.look(byte_order_mark.size()).starts_with(byte_order_mark)) {
    source.take(byte_order_mark.size());
  }
  std::string_view bytes = source.look();
  for (; !bytes.empty(); bytes = source.look()) {
    if (first_binary_byte(bytes) != bytes.npos) source.refuse(no_text(bytes, source.name()));
    take_lines(bytes);
    source.take(bytes.size());
  }
  if (!begun.empty()) reader.line(begun);
  return std::move(reader).finish();
}

/// A quarter of the memory, since a vector that grows takes thrice its size.
std::size_t most_numbers() {
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page = sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return std::numeric_limits<std::size_t>::max() / sizeof(double);
  return static_cast<std::size_t>(pages) * static_cast<std::size_t>(page) / 4 / sizeof(double);
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
    Matrix matrix = read_npy(source, most);
    if (expected == Rows::several && matrix.values.size() == matrix.columns && matrix.columns > 1) {
      source.refuse("it is one row of " + std::to_string(matrix.columns) +
                    " numbers, and an observation is a row; if each is an observation, "
                    "save it with `numpy.save(\"mine.npy\", a.ravel())`");
    }
    return {.columns = default_names(matrix.columns), .values = std::move(matrix.values)};
  }
  constexpr std::size_t beginning = 512;
  const std::string problem = no_text(source.look(beginning), source.name());
  if (!problem.empty()) source.refuse(problem);
  return read_text(source, most, expected);
}

}  // namespace assay::recorded
