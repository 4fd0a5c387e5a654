#pragma once

// The members of a struct that its JSON has, in their order. A struct names them once; whatever
// writes, reads or compares it follows this list.

#include <algorithm>
#include <string_view>
#include <tuple>

namespace assay::reports {

/// Stands at the end of a struct: ASSAY_FIELDS(Tool, name, version). A key is the member's name.
#define ASSAY_FIELDS(Struct, ...)                               \
  bool operator==(const Struct&) const = default;               \
  static constexpr std::string_view field_names = #__VA_ARGS__; \
  auto fields() { return std::tie(__VA_ARGS__); }               \
  auto fields() const { return std::tie(__VA_ARGS__); }

template <class T>
concept has_fields = requires {
  T::field_names;
};

/// Calls visit(key, member) for each field.
template <has_fields T, class Visit>
void for_each_field(T& value, Visit visit) {
  std::string_view rest = T::field_names;
  const auto next_key = [&rest] {
    const std::string_view key = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), key.size() + std::string_view(", ").size()));
    return key;
  };
  std::apply([&](auto&... member) { (visit(next_key(), member), ...); }, value.fields());
}

}  // namespace assay::reports
