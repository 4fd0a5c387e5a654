#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace assay::harness {

/// The 64-bit hash FNV-1a (Fowler, Noll, Vo). It is no protection against deliberate collisions.
/// `start` is the hash of the text before.
constexpr std::uint64_t text_hash(std::string_view text,
                                  std::uint64_t start = 0xcbf29ce484222325U) {
  for (const char c : text) {
    start ^= static_cast<unsigned char>(c);
    start *= 0x100000001b3U;
  }
  return start;
}

/// Two processes that share blocks have these names and values in common.
using Identity = std::vector<std::pair<std::string, std::string>>;

struct Difference {
  std::string name;
  std::string ours;
  std::string theirs;
};
/// The first difference, if any.
inline std::optional<Difference> difference(const Identity& ours, const Identity& theirs) {
  std::map<std::string, std::string> here(ours.begin(), ours.end());
  std::map<std::string, std::string> there(theirs.begin(), theirs.end());
  for (const Identity& identity : {ours, theirs}) {
    for (const auto& [name, unused] : identity) {
      const std::string& our = here.emplace(name, "missing").first->second;
      const std::string& their = there.emplace(name, "missing").first->second;
      if (our != their) return Difference{name, our, their};
    }
  }
  return std::nullopt;
}

}  // namespace assay::harness
