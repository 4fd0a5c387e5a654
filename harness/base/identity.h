#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace assay::harness {

/// What two processes must have in common to share blocks: names and values.
using Identity = std::vector<std::pair<std::string, std::string>>;

struct Difference {
  std::string name;
  std::string ours;
  std::string theirs;
};
/// The first difference, if any.
std::optional<Difference> difference(const Identity& ours, const Identity& theirs);

}  // namespace assay::harness
