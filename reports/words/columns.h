#pragma once

// Text in columns of a terminal. Arguments are clean (reports/text.h).

#include <string>
#include <string_view>
#include <vector>

namespace assay::reports {

/// Columns that a character takes: 0 (combining), 1, or 2 (East Asian wide, emoji). Never fewer
/// than a terminal takes; doubtful ones count as 2.
int columns(char32_t character);

/// Columns of a text without line feeds.
int columns(std::string_view text);

/// The text, or its start and an ellipsis, in at most `width` columns.
std::string shorten(std::string_view text, int width);

/// The text followed by spaces up to `width` columns.
std::string pad_right(std::string text, int width);

/// The text in lines of at most `width` columns, broken at spaces where possible, at characters
/// where not; its own line feeds stay. Never empty.
std::vector<std::string> wrap(std::string_view text, int width);

/// A shell command in lines of at most `width` columns, each but the last ending in a backslash so
/// that the whole can be pasted. Broken only at spaces outside quotes; a word that does not fit has
/// a longer line of its own.
std::vector<std::string> wrap_command(std::string_view command, int width);

}  // namespace assay::reports
