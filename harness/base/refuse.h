#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "estimators/core/mapped.h"
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

}  // namespace assay::harness
