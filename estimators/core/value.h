#pragma once

// Plain data that a user wrote: a YAML document, a `--set` value, a recorded file's header. Every
// node remembers where it was written, so that whatever is wrong with it can be shown there.

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace assay {

/// A place in a text, counted from 1; line 0 means "not from a file".
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "suite.yaml:12:5", "suite.yaml" when no line is known, "" when nothing is.
std::string to_string(const Location&);

/// A mistake in what the user gave: one sentence that says what is wrong and how to mend it, and
/// where. Always found before anything is sampled.
class InputError : public std::runtime_error {
 public:
  /// `line` is that of the place if it cannot be read again, as from a pipe.
  InputError(Location where, const std::string& what, std::optional<std::string> line = {});
  const Location& where() const { return where_; }
  /// The sentence without the place.
  const std::string& message() const { return message_; }
  const std::optional<std::string>& line() const { return line_; }
  /// Mistakes in other parts of the same text.
  const std::vector<InputError>& others() const { return others_; }
  /// Adds a mistake and its others; equal ones count once.
  void add(const InputError& other);

 private:
  Location where_;
  std::string message_;
  std::optional<std::string> line_;
  std::vector<InputError> others_ = {};
};

/// A tree of null, text, numbers, lists and maps. A scalar keeps its text: whether `1e6` is a
/// number or a name is decided by who reads it. Maps keep the order of the file and have unique
/// keys.
class Value {
 public:
  enum class Kind { null, scalar, list, map };
  using Member = std::pair<std::string, Value>;

  Value() = default;
  // Written out in one place, as nearly every file copies and destroys some.
  Value(const Value&);
  Value(Value&&) noexcept;
  Value& operator=(const Value&);
  Value& operator=(Value&&) noexcept;
  ~Value();

  static Value scalar(std::string text, Location where = {});
  static Value list(std::vector<Value> items, Location where = {});
  static Value map(std::vector<Member> members, Location where = {});

  Kind kind() const { return kind_; }
  const Location& where() const { return where_; }
  const std::string& text() const { return text_; }
  const std::vector<Value>& items() const { return items_; }
  const std::vector<Member>& members() const { return members_; }

  /// The member of a map, or nullptr.
  const Value* find(std::string_view key) const;

  /// InputError at the node's place, which says why, unless something holds.
  void require(bool holds, const std::string& why) const;

  /// Typed readings; InputError at the node's place when the text is not that. `what` names the
  /// thing in the message ("parameter `radius`"). Numbers are finite unless they say so themselves.
  double number(std::string_view what) const;
  std::uint64_t count(std::string_view what) const;  ///< accepts 1000, 1e3
  bool boolean(std::string_view what) const;         ///< true or false
  const std::string& string(std::string_view what) const;

  /// One text for equal contents whatever the spelling: map keys sorted, numbers in shortest
  /// round-trip form. Part of the key of a random stream.
  std::string canonical() const;

 private:
  Kind kind_ = Kind::null;
  Location where_;
  std::string text_;
  std::vector<Value> items_;
  std::vector<Member> members_;
};

/// A declared fallback as a Value: YAML scalars, lists and maps, as in `[0, 0, 1]` or
/// `{disc: {radius: .3}}`; `null` is null. The text is a plugin author's, not a user's. Throws
/// std::logic_error on anything else.
Value parse_flow(std::string_view text);

/// The number that the whole of a text is, as std::from_chars reads it.
template <class Number, class... Format>
std::optional<Number> read_as(std::string_view text, Format... format) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, format...);
  return error == std::errc{} && stop == end ? std::optional(number) : std::nullopt;
}

/// A number as C or Python writes it: decimal, `inf`, `nan`, perhaps with a sign.
std::optional<double> parse_number(std::string_view text);
/// The next word of a line, which is removed from it; empty at the end.
std::string_view take_word(std::string_view& line);

/// True if a pattern matches the whole of a text. `*` stands for any text, `?` for any character.
/// The time is at most the product of both lengths.
bool matches(std::string_view pattern, std::string_view text);

/// The shortest text that reads back as this number.
std::string shortest_text(double value);

/// The candidate nearest to `name` in edit distance, or "" when none is near enough to suggest.
std::string nearest(std::string_view name, const std::vector<std::string>& candidates);

/// The end of a message about an unknown name: "; did you mean `x`?" if a candidate is near. Else
/// it is "; " and `otherwise`, or nothing if that is empty.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates,
                         std::string_view otherwise = "");
/// The same of a file that is missing, if one beside it has nearly its name.
std::string near_file(const std::string& file, std::string_view otherwise = "");

/// "a, b".
std::string listed(const std::vector<std::string>& names, std::string_view separator = ", ");
/// The pieces of a text between separators, without blanks around them.
std::vector<std::string> pieces_of(std::string_view text, char separator);

/// "`a`, `b`".
std::string quoted(const std::vector<std::string>& names);

/// A value read as a number of some range. `what` names it in the message ("the lens's radius");
/// InputError at its place where it is none, or lies outside.
double finite_number(const Value& value, const std::string& what);
double at_least_zero(const Value& value, const std::string& what);
double above_zero(const Value& value, const std::string& what);

/// Refuses what is not a map, or a map with a key that is not among `known`.
void require_keys(const Value& value, const std::string& what,
                  const std::vector<std::string>& known);
/// The member of a map; InputError where it is missing.
const Value& required_key(const Value& value, const std::string& what, const char* key);
/// How a message about an unknown name ends: the nearest known one, or all.
std::string alternatives(std::string_view name, const std::vector<std::string>& known);

/// A built-in scene, written as in a suite.
struct NamedScene {
  const char* name;
  const char* text;
};
/// The scene as it is written. A name stands for the text of a built-in one; InputError if there is
/// none.
Value scene_of(const Value& value, std::span<const NamedScene> built_in);

}  // namespace assay
