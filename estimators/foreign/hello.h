#pragma once

// What another program says of its estimator before it is asked for numbers, as lines of text:
//
//   assay 1 text                      the protocol's version; replies as text or binary
//   channel area low 0 high 4         one a channel; what is known of it exactly may follow its
//   name averages                          an observation is the mean of its primaries bias
//   unbiased                     or primaries, bootstrap, start-up, reconstruction ready
//
// Instead of channels, or before channels that are diagnostic, `image 64 48 red green blue` says
// that an observation is an image, `range LOW HIGH` what no element of it leaves, and `independent`
// that its pixels do not depend on each other. With `rays` one number more follows each
// observation's: the rays that it took. `error WORDS` instead of `ready` refuses.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/estimator.h"

namespace assay::foreign {

inline constexpr unsigned protocol_version = 1;

/// How numbers are written: as decimal text, or as little-endian doubles.
enum class Numbers { text, binary };

/// A sentence on what is wrong with what a program said.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The program's own words for why it will not serve.
class Refusal : public ProtocolError {
 public:
  using ProtocolError::ProtocolError;
};

struct Hello {
  Numbers numbers = Numbers::text;
  std::vector<Channel> channels = {};  ///< the elements of the image first
  std::optional<ImageShape> image = {};
  Nature nature = {.averages = false};
  bool rays = false;

  /// Numbers of an observation as they are sent.
  std::size_t width() const { return channels.size() + (rays ? 1 : 0); }
};

/// Whether a text holds a whole hello: one of its lines begins with `ready` or `error`.
bool is_whole_hello(std::string_view text);

/// An observation of more numbers is a mistake in the size of an image; a frame of film has a
/// quarter of them.
inline constexpr std::uint64_t most_numbers = std::uint64_t{1} << 25;

/// Throws ProtocolError naming the line that is wrong, Refusal where the program refuses.
Hello parse_hello(std::string_view text, std::uint64_t most = most_numbers);

/// The text that parse_hello() reads.
std::string to_text(const Hello& hello);

}  // namespace assay::foreign
