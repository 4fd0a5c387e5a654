#pragma once

// The words of another program about its estimator, before it is asked for numbers. They are lines:
//
//   assay 1 text
//   channel area low 0 high 4
//   averages
//   bias unbiased
//   ready
//
// The first has the protocol's version, and the form of replies: `text` or `binary`. Each channel
// has a line. Its exact facts follow its name. The line `averages` says that an observation is the
// mean of its primaries. The bias is unknown (the default), unbiased, primaries, bootstrap,
// start-up or reconstruction.
//
// An image is announced instead of channels, or before diagnostic ones: `image 64 48 red green
// blue`. Its line `range LOW HIGH` is of all elements. Its line `independent` says that pixels are.
// With `rays` one more number follows each observation: the rays that it took. A line `error WORDS`
// instead of `ready` refuses.
//
// A line `sampler lens hemisphere` announces a source of points of this name on this domain.
// Domains are interval (with `low X high Y`), square, triangle, hemisphere and sphere. It can be
// asked for draws, densities and evaluations (reply.h), in binary only. The words `rounding X` may
// follow.

#include <array>
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

/// A sampler inside the program.
struct SamplerNote {
  std::string name;
  Domain domain = Domain::interval;
  std::array<double, 2> bounds = {0, 1};  ///< of an interval
  double rounding = 0;                    ///< 0: the usual one
};

struct Hello {
  Numbers numbers = Numbers::text;
  std::vector<Channel> channels = {};  ///< the elements of the image first
  std::optional<ImageShape> image = {};
  Nature nature = {.averages = false};
  bool rays = false;
  std::vector<SamplerNote> samplers = {};

  /// How many numbers of an observation, the first of them, are means of independent primaries.
  std::size_t means() const { return nature.averages ? channels.size() : 0; }
  /// Numbers of an observation as they are sent.
  std::size_t width() const { return channels.size() + (rays ? 1 : 0); }
};

/// True if a text holds a whole hello: one of its lines begins with `ready` or `error`.
bool is_whole_hello(std::string_view text);

/// An observation of more numbers is a mistake in the size of an image; a frame of film has a
/// quarter of them.
inline constexpr std::uint64_t most_numbers = std::uint64_t{1} << 25;

/// Throws ProtocolError naming the line that is wrong, Refusal where the program refuses.
Hello parse_hello(std::string_view text, std::uint64_t most = most_numbers);

/// The text that parse_hello() reads.
std::string to_text(const Hello& hello);

/// Lines of a hello, each with its end: a channel, an image, a bias, a sampler. Each element of the
/// image has the range of the given channel.
std::string channel_line(const Channel& channel);
std::string image_lines(const ImageShape& image, const Channel& element);
std::string bias_line(std::optional<BiasClass> bias);
std::string sampler_line(const SamplerNote& sampler);

}  // namespace assay::foreign
