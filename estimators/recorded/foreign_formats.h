#pragma once

#include <string>
#include <string_view>

namespace assay::recorded {

/// Names the format of a binary file by its first bytes, and says how to come to numbers. Returns
/// "" for what may be text. `file` is its name, as called() says it.
std::string no_text(std::string_view beginning, const std::string& file);

/// Returns the place of the first byte that no text has, npos where there is none. Escapes of
/// terminals count as text.
std::size_t first_binary_byte(std::string_view bytes);

}  // namespace assay::recorded
