#pragma once

// Plain data between processes of one version of Assay. Numbers go by their bits, lists after their
// lengths. A frame around the data tells their version, and ends with a checksum.
//
// A recipe lets another process draw blocks of a pool. It returns them as plain data. The checksum
// alone tells that they are whole: both processes have one identity.

#include <concepts>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "harness/sampling/pool.h"

namespace assay::harness {

/// The data are not what this program packs; says why.
struct Unpackable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A struct that is packed (const) or unpacked.
template <class T, class Struct>
concept maybe_const = std::same_as<std::remove_const_t<T>, Struct>;

/// Numbers, and structs of numbers of 8 bytes, go by their bits.
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T> ||
    (alignof(T) == 8 && std::conjunction_v<std::is_aggregate<T>, std::is_trivially_copyable<T>>);
static_assert(sizeof(Cost) == 4 * 8 && sizeof(stats::Moments) == 9 * 8 &&
              sizeof(stats::JointMoments) == (2 + 2 * 4 + 25) * 8 &&
              sizeof(ChannelSummary) == (9 + 2) * 8 && sizeof(ChannelPlan) == 5 * 8);

/// Values as bytes, one after another: appended to them (`packs`), or taken off them. A type of its
/// own has a function parts(archive, value), which calls the archive with its members. Taking off
/// throws Unpackable, and allocates no more than the bytes can fill.
template <bool packs>
class BinaryArchive {
 public:
  BinaryArchive() = default;
  explicit BinaryArchive(std::string_view bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&&... values) {
    (pass(values), ...);
  }
  std::string bytes() && { return std::move(bytes_); }
  /// Call it after the last value that is taken off.
  void end() const { require(bytes_.empty(), "there is more in it than expected"); }

  static void require(bool holds, const char* why) {
    if (!holds) throw Unpackable(why);
  }

 private:
  std::string_view taken(std::uint64_t count) {
    require(count <= bytes_.size(), "it is cut short");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  template <class T>
  void pass_bits(T* first, std::size_t size) {
    if constexpr (packs) {
      bytes_.append(reinterpret_cast<const char*>(first), size);
    } else if (const std::string_view bits = taken(size); !bits.empty()) {
      std::memcpy(first, bits.data(), size);
    }
  }
  /// The length of a list whose elements take at least so many bytes each.
  std::uint64_t length(std::uint64_t count, std::uint64_t least) {
    pass(count);
    const bool fits = packs || count <= bytes_.size() / least;
    require(fits, "a list is longer than the data");
    return count;
  }
  template <class List>
  void pass_each(List& list) {
    if constexpr (Plain<typename List::value_type>) {
      pass_bits(list.data(), list.size() * sizeof list[0]);
    } else {
      for (auto& each : list) pass(each);
    }
  }
  template <class T>
  void pass(T& value) {
    if constexpr (!packs && std::same_as<T, bool>) {
      std::uint8_t byte = 0;
      pass(byte);
      require(byte <= 1, "a yes or no is neither");
      value = byte == 1;
    } else if constexpr (Plain<T>) {
      pass_bits(&value, sizeof value);
    } else if constexpr (packs && std::convertible_to<T&, std::string_view>) {
      const std::string_view text = value;
      length(text.size(), 1);
      bytes_ += text;
    } else if constexpr (std::convertible_to<T&, std::string_view>) {
      value = taken(length(0, 1));
    } else if constexpr (requires { value.has_value(); }) {
      bool there = value.has_value();
      pass(there);
      if constexpr (!packs) {
        value.reset();
        if (there) value.emplace();
      }
      if (there) pass(*value);
    } else if constexpr (requires { value.use_count(); }) {
      auto shared = std::const_pointer_cast<std::remove_const_t<typename T::element_type>>(value);
      if constexpr (!packs)
        value = shared = std::make_shared<typename decltype(shared)::element_type>();
      pass(*shared);
    } else if constexpr (requires { typename T::mapped_type; }) {
      const auto size = length(value.size(), sizeof(std::uint64_t));
      if constexpr (packs) {
        for (const auto& each : value) pass(each);
      } else {
        for (std::uint64_t i = 0; i < size; ++i) {
          std::pair<typename T::key_type, typename T::mapped_type> each;
          pass(each);
          value.insert(std::move(each));
        }
      }
    } else if constexpr (requires { typename T::value_type; }) {
      using Each = typename T::value_type;
      const auto size = length(value.size(), Plain<Each> ? sizeof(Each) : sizeof(std::uint64_t));
      if constexpr (!packs) value.resize(size);
      pass_each(value);
    } else if constexpr (requires {
                           value.first;
                           value.second;
                         }) {
      (*this)(value.first, value.second);
    } else {
      parts(*this, value);
    }
  }

  std::conditional_t<packs, std::string, std::string_view> bytes_;
};
using Packer = BinaryArchive<true>;
using Unpacker = BinaryArchive<false>;

inline constexpr std::string_view magic = "assay ";

std::string framed(std::string_view bytes);
/// The bytes in a frame. Throws Unpackable for another version, and for data that are cut short or
/// damaged.
std::string_view unframed(std::string_view frame);

template <class... T>
std::string packed(const T&... values) {
  Packer pack;
  pack(values...);
  return framed(std::move(pack).bytes());
}

template <class... T>
void unpack(std::string_view frame, T&... values) {
  Unpacker unpacker(unframed(frame));
  unpacker(values...);
  unpacker.end();
}

template <class Archive, maybe_const<Recipe> T>
void parts(Archive& a, T& recipe) {
  a(recipe.key, recipe.primaries, recipe.plan, recipe.grouped_channels, recipe.kept_observations,
    recipe.marks);
}

/// A block of a pool, or a part of what it has drawn.
void parts(Packer& a, const Pool::Block& block);
void parts(Unpacker& a, Pool::Block& block);

}  // namespace assay::harness
