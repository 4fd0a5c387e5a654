#pragma once

// Questions to another program and its replies.
//
// A question asks for the observations first, first + 1, …, first + count - 1 of a stream, each
// built from so many primaries. The reply is the numbers of each observation in order, and then the
// question once more: whatever else came through the pipe, and whatever is missing, then shows.
//
// Binary: a question is four 64-bit little-endian words: key, first, count, primaries. Text: a line
// of five decimal numbers: the key's high and low 32 bits (many languages have no unsigned 64-bit
// integers), first, count, primaries; of the reply, each observation is a line.
//
// A question of no primaries is to a sampler, in binary only: its number in the hello in the place
// of the key, what is asked in the place of the first observation, and so many items follow it.
// They are asked as
//   draws        key and observation of a stream   point (three numbers), density, weight, and
//                                                  whether a point came out, 0 or 1
//   densities    a point, three numbers            a number
//   evaluations  a point                           a number

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/foreign/hello.h"

namespace assay::foreign {

/// What is asked of a sampler: 0, 1 or 2, plus 4 where denormals are to be flushed to zero.
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
  /// Of a question to a sampler.
  Asked asked() const { return Asked{first % denormals_flushed}; }
};

/// As it is sent.
std::string to_bytes(const Question& question, Numbers numbers);

/// "observation 7", "observations 0 to 255", "32 densities".
std::string to_text(const Question& question);

/// Whether two replies are the same, numbers that are not finite too.
bool same_bits(const std::vector<double>& a, const std::vector<double>& b);

/// A reply as it comes in, in pieces of any size.
class Reply {
 public:
  /// `width` numbers an observation.
  Reply(const Question& question, std::size_t width, Numbers numbers);

  /// Where the next bytes are to be written: never empty before the reply is complete.
  std::span<char> space();
  /// That so many bytes were written there; whether the reply is now complete. Throws ProtocolError
  /// where they are none that could be part of it.
  bool take(std::size_t count);
  /// The numbers of a complete reply, observation by observation.
  std::vector<double> numbers();
  /// Why the reply cannot become complete, though nothing more has come: it ended too early; ""
  /// where it may.
  std::string ends_early() const;
  /// What has come so far, in words.
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
