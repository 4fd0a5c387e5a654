#pragma once

// The words of one line of a ledger.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace assay::harness {

/// In double quotes, with \" \\ and \n \t \r for what a line cannot hold.
std::string in_quotes(std::string_view text);

/// "line | 1a2b3c4d": the low 32 bits of a hash.
std::string with_check(const std::string& line, std::uint64_t hash);
/// A line and what stands behind its last bar; all of it and "" where there is no bar.
std::pair<std::string_view, std::string_view> split_check(std::string_view line);

/// Reads the fields of a line from left to right; nullopt where the next field is another.
class LineFields {
 public:
  explicit LineFields(std::string_view line) : rest_(line) {}

  bool word(std::string_view wanted);  ///< steps over it if it is next
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
