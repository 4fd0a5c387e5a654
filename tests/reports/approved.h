#pragma once

#include "tests/prelude.h"

namespace assay::tests {

/// Compares a text with its approved file in tests/golden, or writes it there, if ASSAY_APPROVE is
/// in the environment (reports/README.md).
inline void expect_approved(const std::string& name, const std::string& written) {
  const std::filesystem::path file = std::filesystem::path(ASSAY_SOURCE_DIR "/tests/golden") / name;
  if (std::getenv("ASSAY_APPROVE") != nullptr) std::ofstream(file, std::ios::binary) << written;
  const std::string wanted = bytes_in(file);
  const auto at = static_cast<std::size_t>(
      std::mismatch(written.begin(), written.end(), wanted.begin(), wanted.end()).first -
      written.begin());
  EXPECT_TRUE(written == wanted) << name << " differs at byte " << at
                                 << "\nwritten:  " << written.substr(at, 120) << "\napproved: "
                                 << wanted.substr(std::min(at, wanted.size()), 120);
}

}  // namespace assay::tests
