#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace assay::harness {

/// The text in double quotes, with the escapes \" \\ \n \t \r.
std::string in_quotes(std::string_view text);

/// "line | 1a2b3c4d": the low 32 bits of a hash.
std::string with_check(const std::string& line, std::uint64_t hash);
/// The text before and after the last bar; the whole and "" if there is none.
std::pair<std::string_view, std::string_view> split_check(std::string_view line);

/// Reads the fields of a line from left to right; nullopt if the next field is another.
class LineFields {
 public:
  explicit LineFields(std::string_view line) : rest_(line) {}

  bool word(std::string_view wanted);  ///< skips the word if it is next
  std::optional<std::string> any_word();
  std::optional<std::uint64_t> count();
  std::optional<double> number();  ///< finite
  std::optional<std::string> text();
  bool at_end();

 private:
  std::string_view next();
  void skip_blanks();

  std::string_view rest_;
};

}  // namespace assay::harness
