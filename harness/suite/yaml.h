#pragma once

// Strict YAML: text that readers could understand differently is an error at its place.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimators/core/value.h"
#include "harness/base/refuse.h"

namespace assay::harness {

/// A YAML text as a Value, with its lines and the places of its keys.
///
/// A node's place is its first character. Quoted text begins after the quote, and a block scalar
/// (`|`, `>`) at its first line. Columns count bytes.
class Document {
 public:
  /// No text: keys have the places of their values.
  Document() = default;
  /// Reads one YAML document. InputError at its place in `file` for anything else, and for merge
  /// keys, anchors, tags and missing values. Every node has `only_place` if it is given.
  Document(std::string file, std::string_view text, std::optional<Location> only_place = {});

  const Value& root() const { return root_; }
  /// The place of the key of this member of a map; for other values their own place.
  Location key(const Value& member) const;
  /// A line without its end, counted from 1; "" where there is none.
  std::string_view line(int number) const;

 private:
  friend class DocumentBuilder;

  /// The place, or the end of the text if it lies behind that.
  Location at_most_last(int line, int column) const;

  std::string file_;
  std::optional<Location> only_place_;
  std::vector<std::string> lines_;
  std::map<std::pair<int, int>, Location> keys_;
  Value root_;
};

/// Reads one line of YAML flow from a command line. `where` is the place of every node and error.
Value read_flow(std::string_view text, const Location& where);

/// Splits at commas that are outside brackets and quotes: `a=1,b=[1, 2]` has two pieces.
std::vector<std::string> split_outside_brackets(std::string_view text);

/// A map of a suite file. The constructor refuses unknown keys.
class Keys {
 public:
  /// `what` names the map in messages: "a suite", "a test". Messages offer the known keys, or the
  /// example if it is no map.
  Keys(const Document& document, const Value& map, std::string what, std::string_view example,
       const std::vector<std::string>& known);

  const Value* find(std::string_view key) const { return map_.find(key); }
  /// The value of the key. InputError at the map if it is missing, with a line to write.
  const Value& require(std::string_view key, std::string_view example) const;

 private:
  const Value& map_;
  std::string what_;
};

/// "; did you mean `x`?", or "; " and all candidates if none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

/// True in [1e-9, 0.5]: a smaller rate, divided among tests and looks, is lost beside 1.
bool is_error_rate(double rate);

/// A finite number above 0; InputError at the value.
double positive_number(const Value& value, std::string_view what);
double error_rate(const Value& value, std::string_view what);  ///< is_error_rate
std::uint64_t count_from(const Value& value, std::string_view what, std::uint64_t least);

/// Non-empty text of one line; InputError otherwise.
std::string one_line(const Value& value, std::string_view what);

/// The index of the text among those allowed; InputError otherwise.
std::size_t choice(const Value& value, std::string_view what,
                   const std::vector<std::string>& allowed);

}  // namespace assay::harness
