#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/value.h"

namespace assay::harness {

/// The whole of a text file. InputError when it is missing, a folder, unreadable or over 16 MiB.
std::string read_text_file(const std::string& file);

/// The bytes of any file, if it can be read.
std::optional<std::string> bytes_of(const std::string& file);

std::vector<std::string_view> lines_of(std::string_view text);

/// Throws InputError at the first byte that is not UTF-8 or is a control character other than tab
/// and line end.
void require_utf8(std::string_view text, const std::string& file);

/// The line, and under it a caret below the column (bytes, from 1). A long line is cut to the
/// neighbourhood of the column; control characters are replaced (reports::clean).
std::string caret_below(std::string_view line, int column);

}  // namespace assay::harness
