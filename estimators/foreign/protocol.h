#pragma once

// The protocol of programs, as README.md has it: the hello, questions and replies.
//
// A hello is lines of words about the estimator, before the program is asked for numbers. A
// question asks for the observations first, first + 1, …, first + count - 1 of a stream, each built
// from so many primaries. The reply has the numbers of each observation in order, then the question
// once more. So a stray or a missing word shows.
//
// A question of no primaries is to a sampler, in binary only. Its words are the sampler's number in
// the hello, the kind of the question, the number of items, and 0. The items follow.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/mapped.h"
#include "estimators/core/quoting.h"
#include "estimators/core/value.h"
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
  std::optional<ImageShape> image = {};
  Channel element = {};                ///< Known of every element of the image.
  std::vector<Channel> channels = {};  ///< Those after the elements.
  Nature nature = {.averages = false};
  bool rays = false;
  std::vector<SamplerNote> samplers = {};

  std::size_t channel_count() const { return (image ? image->elements() : 0) + channels.size(); }
  /// How many numbers of an observation, the first of them, are means of independent primaries.
  std::size_t means() const { return nature.averages ? channel_count() : 0; }
  /// Numbers of an observation as they are sent.
  std::size_t width() const { return channel_count() + (rays ? 1 : 0); }
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
  /// The question for one of its observations alone.
  Question alone(std::uint64_t place) const { return {key, first + place, 1, primaries}; }
  /// The kind of a question to a sampler.
  Asked asked() const { return Asked{first % denormals_flushed}; }
};

std::string to_bytes(const Question& question, Numbers numbers);

/// "observation 7", "observations 0 to 255", "32 densities".
std::string to_text(const Question& question);

/// True if two replies have the same bits, NaN included.
bool same_bits(std::span<const double> a, std::span<const double> b);

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

// Lines and words of what programs write to each other.

/// The words of a line, which blanks and tabs separate.
inline std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (auto word = take_word(line); !word.empty(); word = take_word(line)) words.push_back(word);
  return words;
}

/// The coordinates that the domain uses: "(0.25, 1)".
inline std::string text_of(const Point& point, Domain domain) {
  return "(" + listed(mapped(std::span(point).first(coordinates(domain)), shortest_text)) + ")";
}

/// The last words of a text, on one line. Cut at a blank, if there is one.
inline std::string last_words(std::string_view text) {
  constexpr std::size_t most = 300;
  std::size_t begin = text.size() > most ? text.size() - most : 0;
  const std::size_t blank = text.find_first_of(" \n", begin);
  if (begin > 0 && blank != std::string::npos) begin = blank;
  const std::string legible = shown(text.substr(begin), 2 * most);
  std::string out;
  for (const std::string_view word : words_of(legible)) out += " " + std::string(word);
  return out.empty() ? "" : (begin > 0 ? " …" : "") + out;
}

/// The end of a sentence on a program: its standard error, "" where that is empty. The last line
/// comes first, because it has the reason.
inline std::string ending_with(std::string_view errors) {
  const std::size_t end = errors.find_last_not_of(" \t\r\n");
  if (end == std::string_view::npos) return "";
  errors = errors.substr(0, end + 1);
  const std::size_t line = errors.rfind('\n') + 1;
  const std::string before = last_words(errors.substr(0, line));
  return "; its standard error ends with:" + last_words(errors.substr(line)) +
         (before.empty() ? "" : "; before that:" + before);
}

}  // namespace assay::foreign
