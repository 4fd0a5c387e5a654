#pragma once

#include <string_view>

namespace assay {

/// True if a pattern matches the whole of a text. `*` stands for any text, `?` for any character.
/// The time is at most the product of both lengths.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace assay
