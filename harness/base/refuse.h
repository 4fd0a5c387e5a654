#pragma once

#include <fmt/format.h>

#include <optional>
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

/// The mistakes of parts that are read each by itself.
class Mistakes {
 public:
  /// Reads a part, and keeps its mistakes.
  template <class Part>
  void attempt(const Part& read) {
    try {
      read();
    } catch (const InputError& mistake) {
      if (!all_) all_ = mistake;
      all_->add(mistake);
    }
  }

  bool any() const { return all_.has_value(); }
  void refuse_any() const {
    if (all_) throw InputError(*all_);
  }

 private:
  std::optional<InputError> all_ = {};
};

}  // namespace assay::harness
