#pragma once

// Text of users and of other programs, as a message repeats it.

#include <cstddef>
#include <string>
#include <string_view>

namespace assay {

/// Returns a word as a shell reads it back: in quotes where it needs them.
std::string shell_quoted(const std::string& word);

/// Returns a text as Python reads it back, in quotes.
std::string python_quoted(const std::string& text);

/// Returns the beginning of a text on one line, `most` bytes and "…" where it is longer. A control
/// character becomes `?`. No character of UTF-8 is cut.
std::string shown(std::string_view text, std::size_t most = 60);

}  // namespace assay
