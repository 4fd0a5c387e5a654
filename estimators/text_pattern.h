#pragma once

#include <string_view>

namespace assay {

/// Whether a pattern in which `*` stands for any text and `?` for any character matches the whole
/// of a text. In time of at most the product of both lengths.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace assay
