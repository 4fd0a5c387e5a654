#include "harness/failure.h"

#include "harness/suite.h"
#include "harness/text_file.h"

namespace assay::harness {

std::string failure_text(const InputError& error, const std::string& claim) {
  const Location& where = error.where();
  const bool in_claim = where.file == "claim" && where.line == 1 && !claim.empty();
  return std::string(error.what()) + "\n" +
         (in_claim ? caret_below(claim, where.column) : excerpt(where));
}

}  // namespace assay::harness
