#include "harness/base/identity.h"

#include <algorithm>

namespace assay::harness {

std::optional<Difference> difference(const Identity& ours, const Identity& theirs) {
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
