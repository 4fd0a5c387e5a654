#pragma once

#include <string_view>
#include <vector>

namespace assay::harness {

/// A file that the program carries: a template of `assay init`, or a script of `assay completion`.
struct CarriedFile {
  std::string_view path;  ///< below harness/command, as "init/suite/mine.yaml"
  std::string_view text;
};

/// In the order of their paths.
const std::vector<CarriedFile>& carried_files();

}  // namespace assay::harness
