#pragma once

// A line of numbers or names, taken apart.

#include <string>
#include <string_view>
#include <vector>

namespace assay::recorded {

/// The separator if there is no other: white space of any length.
inline constexpr char blank = ' ';

/// A piece of a line and the column it begins at, counted from 1.
struct Field {
  std::string_view text;
  int column;
};

/// Returns the bytes from `begin` to before `end` without the white space around them.
Field trimmed(std::string_view line, std::size_t begin, std::size_t end);

/// Returns the line without its comment. A comment begins where a field could, so that `1.#INF` has
/// none.
std::string_view without_comment(std::string_view line);

/// Returns what separates the fields of a line: `;`, else `,`, else a tab, else `blank`. Separators
/// within quotes do not count, here as in split().
char separator_of(std::string_view line);

/// Returns the fields of a line; none where it is empty. A tab at its end is no separator.
std::vector<Field> split(std::string_view line, char separator);

/// Returns the text between quotes, a doubled one for one.
std::string unquoted(std::string_view text);

/// The number that a text is, if it is one.
struct Parsed {
  double value = 0;
  bool is_number = false;
  bool out_of_range = false;
};

/// Reads a number as C++ writes it, also in quotes. With `decimal_comma` a comma may be its point.
Parsed parse(std::string_view text, bool decimal_comma);

/// Tells whether a program wrote that a number is missing.
bool is_missing(std::string_view text);

/// Tells whether a field of a first line may name a column: nothing that was meant as a number.
bool may_be_name(const Field& field);

}  // namespace assay::recorded
