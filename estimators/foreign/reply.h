#pragma once

// Questions to another program and its replies.
//
// A question asks for the observations first, first + 1, …, first + count - 1 of a stream, each
// built from so many primaries. The reply has the numbers of each observation in order, then the
// question once more. So a stray or a missing word shows.
//
// In binary a question is four 64-bit little-endian words: key, first, count, primaries. In text it
// is a line of five decimal numbers: the key's high and low 32 bits, first, count, primaries. Each
// observation is a line.
//
// A question of no primaries is to a sampler, in binary only. Its words are the sampler's number in
// the hello, the kind of the question, the number of items, and 0. The items follow.
//   Draws: an item is the key and observation of a stream. The reply is the point (three numbers),
//          density, weight, and 1 or 0: a point came out, or none.
//   Densities, evaluations: an item is a point, three numbers. The reply is a number.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/foreign/hello.h"

namespace assay::foreign {

/// The kind of a question to a sampler: 0, 1 or 2, plus 4 if denormals are to be flushed to zero.
enum class Asked : std::uint64_t { draws, densities, evaluations };
inline constexpr std::uint64_t denormals_flushed = 4;

/// Words of an item, and numbers of the reply to it.
constexpr std::size_t item_words(Asked what) { return what == Asked::draws ? 2 : 3; }
constexpr std::size_t numbers_of(Asked what) { return what == Asked::draws ? 6 : 1; }

struct Question {
  std::uint64_t key = 0;
  std::uint64_t first = 0;
  std::uint64_t count = 1;
  std::uint64_t primaries = 1;

  bool is_to_sampler() const { return primaries == 0; }
  /// The kind of a question to a sampler.
  Asked asked() const { return Asked{first % denormals_flushed}; }
};

std::string to_bytes(const Question& question, Numbers numbers);

/// "observation 7", "observations 0 to 255", "32 densities".
std::string to_text(const Question& question);

/// True if two replies have the same bits, NaN included.
bool same_bits(const std::vector<double>& a, const std::vector<double>& b);

/// A reply as it comes in, in pieces of any size.
class Reply {
 public:
  /// `width` numbers an observation.
  Reply(const Question& question, std::size_t width, Numbers numbers);

  /// The room for the next bytes. It is never empty before the reply is complete.
  std::span<char> space();
  /// That so many bytes were written there; whether the reply is now complete. Throws ProtocolError
  /// where they are none that could be part of it.
  bool take(std::size_t count);
  /// The numbers of a complete reply, observation by observation.
  std::vector<double> numbers();
  /// Why the reply cannot become complete, though nothing more has come: it ended too early; ""
  /// where it may.
  std::string ends_early() const;
  /// The bytes that have come so far, in words.
  std::string so_far() const;

 private:
  std::size_t wanted() const { return static_cast<std::size_t>(question_.count) * width_; }
  bool take_binary();
  bool take_text();
  void take_line(std::string_view line);
  void refuse_surplus(std::string_view bytes) const;

  Question question_;
  std::size_t width_;
  Numbers kind_;
  std::string end_;    ///< the question, which ends the reply
  std::string bytes_;  ///< room for what comes
  std::size_t filled_ = 0;
  std::size_t parsed_ = 0;  ///< text: bytes of whole lines that have been read
  std::vector<double> numbers_;
};

}  // namespace assay::foreign
