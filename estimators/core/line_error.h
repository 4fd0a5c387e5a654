#pragma once

#include <string>
#include <string_view>

#include "estimators/core/value.h"

namespace assay {

/// A mistake in a line that is shown with it: what came from a pipe cannot be read again.
class LineError : public InputError {
 public:
  LineError(Location where, const std::string& what, std::string_view line)
      : InputError(std::move(where), what), line_(line) {}
  const std::string& line() const { return line_; }

 private:
  std::string line_;
};

}  // namespace assay
