#pragma once

// Set-ups whose observations another program renders into files that are kept.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "estimators/stream.h"

namespace assay::foreign {

/// A file that is not there yet, and a shell's line that makes it, whole or not at all.
struct MissingFile {
  std::string command;
  std::uint32_t seed;
  std::string file;
};

/// A program that was started again, and why.
struct Retry {
  std::uint32_t seed;
  std::uint64_t retry;  ///< from 1
  std::string reason;
};

class Rendered {
 public:
  virtual ~Rendered() = default;
  /// The missing files of the first `count` observations of a stream.
  virtual std::vector<MissingFile> missing(StreamKey key, std::uint64_t count,
                                           std::uint64_t primaries) const = 0;
  /// The programs started again so far, by seed.
  virtual std::vector<Retry> retries() const = 0;
};

/// The file of a program where a shell would find it: in the folders of PATH. A word with a slash
/// is relative to `folder`. Empty if there is none that may be executed.
std::filesystem::path program_path(const std::string& word, const std::filesystem::path& folder);

}  // namespace assay::foreign
