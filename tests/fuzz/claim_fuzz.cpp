// Claims as users type them (harness/claim.h). Every text is a claim, or is refused with a column.
// A claim is written and read again as the same.

#include "estimators/core/value.h"
#include "harness/language/claim.h"
#include "tests/fuzz/case.h"

using namespace assay;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  const Location place{.file = "suite.yaml", .line = 7, .column = 3};
  try {
    const std::string written = to_string(harness::parse_claim(text, place));
    require(to_string(harness::parse_claim(written, place)) == written);
  } catch (const InputError& error) {
    require(!error.message().empty() && error.where().file == place.file);
    const int beyond = error.where().column - place.column;
    require(beyond >= 0 && beyond <= static_cast<int>(size));
  }
  return 0;
}
