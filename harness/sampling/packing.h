#pragma once

// Plain data between processes of one version of Assay. Numbers go by their bits, lists after their
// lengths. A frame around the data tells their format and byte order, and ends with a checksum.
//
// A recipe lets another process draw blocks of a pool. It returns them as plain data.

#include <concepts>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/sampling/pool.h"

namespace assay::harness {

/// The data are not what this program packs; says why.
class Unpackable : public std::runtime_error {
 public:
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

/// Appends values to bytes. A type of its own has a function parts(archive, value), which calls the
/// archive with its members; Unpacker takes the same function.
class Packer {
 public:
  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  /// A list whose length the reader knows.
  template <class List>
  void fixed(const List& list) {
    put(static_cast<std::uint64_t>(list.size()));
    if constexpr (Plain<typename List::value_type>) {
      bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof list[0]);
    } else {
      for (const auto& each : list) put(each);
    }
  }
  std::string bytes() && { return std::move(bytes_); }

 private:
  template <Plain T>
  void put(const T& number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void put(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
  }
  void put(const std::string& text) { put(std::string_view(text)); }
  template <class T>
  void put(const std::vector<T>& list) {
    fixed(list);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class A, class B>
  void put(const std::pair<A, B>& pair) {
    put(pair.first);
    put(pair.second);
  }
  template <class T>
  void put(const T& value) {
    parts(*this, value);
  }

  std::string bytes_;
};

/// Reads what a Packer wrote. Throws Unpackable; allocates no more than the bytes can fill.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  template <class List>
  void fixed(List& list) {
    require(length(0) == list.size(), "a list has another length than its plan says");
    get_each(list);
  }
  /// Call it after the last value.
  void end() const { require(rest_.empty(), "there is more in it than expected"); }

  static void require(bool holds, const char* why) {
    if (!holds) throw Unpackable(why);
  }

 private:
  std::string_view taken(std::uint64_t count) {
    require(count <= rest_.size(), "it is cut short");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  /// A length of elements that take at least so many bytes each.
  std::uint64_t length(std::uint64_t least) {
    std::uint64_t count = 0;
    get(count);
    require(least == 0 || count <= rest_.size() / least, "a list is longer than the data");
    return count;
  }
  template <class List>
  void get_each(List& list) {
    if constexpr (Plain<typename List::value_type>) {
      const std::string_view bytes = taken(list.size() * sizeof list[0]);
      if (!bytes.empty()) std::memcpy(list.data(), bytes.data(), bytes.size());
    } else {
      for (auto& each : list) get(each);
    }
  }
  template <Plain T>
  void get(T& number) {
    std::memcpy(&number, taken(sizeof number).data(), sizeof number);
  }
  void get(bool& value) {
    std::uint8_t byte = 0;
    get(byte);
    require(byte <= 1, "a yes or no is neither");
    value = byte == 1;
  }
  void get(std::string_view& text) { text = taken(length(1)); }  ///< of the reader's bytes
  void get(std::string& text) { text = taken(length(1)); }
  template <class T>
  void get(std::vector<T>& list) {
    list.resize(length(Plain<T> ? sizeof(T) : sizeof(std::uint64_t)));
    get_each(list);
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) get(value.emplace());
  }
  template <class A, class B>
  void get(std::pair<A, B>& pair) {
    get(pair.first);
    get(pair.second);
  }
  template <class T>
  void get(T& value) {
    parts(*this, value);
  }

  std::string_view rest_;
};

/// The beginning of a frame.
inline constexpr std::string_view magic = "assay ";

std::string framed(std::string_view bytes);
/// The bytes in a frame. Throws Unpackable for another format or byte order, and for data that are
/// cut short or damaged.
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

/// A pool that draws by the recipe. Throws Unpackable if the set-up cannot.
Pool pool_of(const Recipe& recipe, std::shared_ptr<const Setup> setup);

/// Packs a block that was drawn, to stand in a frame.
std::string packed_block(const Pool::Block& block);
/// Reads it as a block of the pool that begins at observation `first`. Throws Unpackable unless it
/// has the shape that the pool's plan says, so that it can be folded.
Pool::Block unpacked_block(std::string_view bytes, const Pool& pool, std::uint64_t first);

/// Packs a block's sums alone, or what it keeps.
std::string packed_sums(const Pool::Block& block);
std::string packed_kept(const Pool::Block& block);
/// Adds what packed_kept packed of the observations that follow.
void add_kept(std::string_view bytes, Pool::Block& block);
/// Adds the packed sums of a pool to what it keeps. Throws Unpackable unless both fit the pool.
Pool::Block unpacked_drawn(std::string_view sums, Pool::Block&& kept, const Pool& pool);

}  // namespace assay::harness
