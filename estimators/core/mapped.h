#pragma once

#include <cstddef>
#include <functional>
#include <type_traits>
#include <vector>

namespace assay {

/// What a function makes of each element of a list, in order.
template <class List, class Function>
auto mapped(List&& list, const Function& function) {
  std::vector<std::decay_t<decltype(std::invoke(function, *list.begin()))>> made;
  if constexpr (requires { list.size(); }) made.reserve(list.size());
  for (auto&& element : list) made.push_back(std::invoke(function, element));
  return made;
}

/// What it makes of 0 to count - 1.
template <class Function>
auto mapped_indices(std::size_t count, const Function& function) {
  std::vector<std::decay_t<decltype(function(count))>> made;
  made.reserve(count);
  for (std::size_t i = 0; i < count; ++i) made.push_back(function(i));
  return made;
}

}  // namespace assay
