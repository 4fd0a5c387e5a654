#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace assay::harness {

/// Two processes that share blocks have these names and values in common.
using Identity = std::vector<std::pair<std::string, std::string>>;

struct Difference {
  std::string name;
  std::string ours;
  std::string theirs;
};
/// The first difference, if any.
std::optional<Difference> difference(const Identity& ours, const Identity& theirs);

}  // namespace assay::harness
