#pragma once

// YAML read strictly: what two readers could understand differently is an error at its place.

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimators/core/value.h"

namespace assay::harness {

/// A YAML text as a Value, with what a Value does not know: the lines, and where keys stand.
///
/// A node's place is its first character; of quoted text the one after the quote, of a block scalar
/// (`|`, `>`) the first of its first line. Columns count bytes.
class Document {
 public:
  Document(std::string file, std::string_view text);

  const Value& root() const { return root_; }
  const std::string& file() const { return file_; }
  /// Where the key of this member of a map stands; the value's own place for anything else.
  Location key(const Value& member) const;
  /// A line without its end, counted from 1; "" where there is none.
  std::string_view line(int number) const;

 private:
  friend class DocumentBuilder;

  /// The place, or the end of the text for one behind it.
  Location at_most_last(int line, int column) const;

  std::string file_;
  std::vector<std::string> lines_;
  std::map<std::pair<int, int>, Location> keys_;
  Value root_;
};

/// Reads one YAML document. InputError at its place for: a file that cannot be read or is not
/// UTF-8, a syntax error, no document or several, a tab in indentation, a key that is repeated,
/// empty or not text, a merge key `<<`, an anchor or alias, a tag, a key or list item without a
/// value, nesting deeper than 64.
Document read_yaml_file(const std::string& file);
Document read_yaml_text(std::string_view text, const std::string& file);

/// A value as it stands on a command line: one line of YAML flow. `where` becomes the place of
/// every node and of every error.
Value read_flow(std::string_view text, const Location& where);

/// Splits at commas that are outside brackets and quotes: `a=1,b=[1, 2]` has two pieces.
std::vector<std::string> split_outside_brackets(std::string_view text);

}  // namespace assay::harness
