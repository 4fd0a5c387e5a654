#pragma once

#include <algorithm>
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
inline std::optional<Difference> difference(const Identity& ours, const Identity& theirs) {
  const auto value = [](const Identity& identity, const std::string& name) {
    const auto found = std::ranges::find(identity, name, &Identity::value_type::first);
    return found == identity.end() ? "none" : found->second;
  };
  for (const Identity& identity : {ours, theirs}) {
    for (const auto& [name, unused] : identity) {
      Difference found{name, value(ours, name), value(theirs, name)};
      if (found.ours != found.theirs) return found;
    }
  }
  return std::nullopt;
}

}  // namespace assay::harness
