#pragma once

#include <concepts>
#include <type_traits>

namespace assay::reports {

/// A part of the record that is written (const) or read.
template <class T, class Struct>
concept maybe_const = std::same_as<std::remove_const_t<T>, Struct>;

}  // namespace assay::reports
