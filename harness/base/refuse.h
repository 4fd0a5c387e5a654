#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "estimators/core/value.h"

namespace assay::harness {

/// Throws InputError at the place of a mistake, with a sentence that says what to do.
[[noreturn]] inline void refuse(const Location& where, const std::string& sentence) {
  throw InputError(where, sentence);
}

/// The same for a sentence with parts, by fmt::format.
template <class... Parts>
requires(sizeof...(Parts) > 0)
    [[noreturn]] void refuse(const Location& where, fmt::format_string<Parts...> sentence,
                             Parts&&... parts) {
  throw InputError(where, fmt::format(sentence, std::forward<Parts>(parts)...));
}

/// One text of each row, such as the names that a message offers.
template <class Rows, class Text>
std::vector<std::string> names_of(Rows&& rows, Text text) {
  std::vector<std::string> names;
  for (const auto& row : rows) names.push_back(std::invoke(text, row));
  return names;
}

}  // namespace assay::harness
