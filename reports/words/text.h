#pragma once

// Text that may come from a suite file, a plugin or another program, made safe for each format, and
// in columns of a terminal.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace assay::reports {

/// The substitute for a byte or character that cannot be shown.
inline constexpr char32_t replacement_character = 0xFFFD;

/// The code point that starts at `position`, which moves behind it. A byte that starts no valid
/// UTF-8 sequence gives the replacement character, and `position` moves by one. Overlong forms,
/// surrogates and cut sequences are not valid. `position` must be below text.size().
char32_t next_code_point(std::string_view text, std::size_t& position);

/// Appends a code point as UTF-8.
void append_code_point(std::string& text, char32_t code_point);

/// Valid UTF-8 without control characters. Line feed and tab stay; CR LF becomes LF. Characters
/// that a terminal or an XML reader must not meet become U+FFFD: C0, C1, DEL, line and direction
/// controls, non-characters. Idempotent.
std::string clean(std::string_view text);

/// clean(), with line feeds and tabs as spaces: for names, headings and table cells.
std::string one_line(std::string_view text);

/// No-break spaces as plain ones: terminals and programs treat them in their own ways.
std::string plain_spaces(std::string text);

/// A character and what is written for it.
struct Form {
  char character;
  std::string_view written;
};
std::string escape(std::string_view text, std::span<const Form> forms);

/// clean(), with & < > " ' as references: for text between XML or HTML tags.
std::string escape_xml(std::string_view text);

/// escape_xml() with line feeds and tabs as references, which attribute values would lose
/// otherwise.
std::string escape_attribute(std::string_view text);

/// one_line(), with everything that Markdown or HTML gives a meaning escaped: for a table cell or a
/// heading of GitHub's or GitLab's dialect.
std::string escape_markdown(std::string_view text);

/// At most `bytes` of the text, cut between characters; what is missing is said at the end.
std::string cap(std::string text, std::size_t bytes);

/// Columns that a character of clean text takes: 0 (combining), 1, or 2 (East Asian wide, emoji).
/// Never fewer than a terminal takes; doubtful ones count as 2.
int columns(char32_t character);

/// Columns of a text without line feeds.
int columns(std::string_view text);

/// The text, or its start and an ellipsis, in at most `width` columns.
std::string shorten(std::string_view text, int width);

/// The text followed by spaces up to `width` columns.
std::string pad_right(std::string text, int width);

/// One word of a shell.
std::string in_single_quotes(const std::string& text);

/// The text in lines of at most `width` columns, broken at spaces where possible, at characters
/// where not; its own line feeds stay. Never empty.
std::vector<std::string> wrap(std::string_view text, int width);

/// A shell command in lines of at most `width` columns, each but the last ending in a backslash so
/// that the whole can be pasted. Broken only at spaces outside quotes; a word that does not fit has
/// a longer line of its own.
std::vector<std::string> wrap_command(std::string_view command, int width);

}  // namespace assay::reports
