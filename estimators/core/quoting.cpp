#include "estimators/core/quoting.h"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <iomanip>
#include <sstream>

namespace assay {

std::string shell_quoted(const std::string& word) {
  constexpr const char* harmless =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:%+@";
  if (!word.empty() && word.find_first_not_of(harmless) == std::string::npos) return word;
  return "'" + boost::replace_all_copy(word, "'", "'\\''") + "'";
}

std::string python_quoted(const std::string& text) {
  std::ostringstream out;
  out << std::quoted(text);
  return out.str();
}

std::string shown(std::string_view text, std::size_t most) {
  constexpr std::size_t longest_character = 4;
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80; };
  std::size_t end = std::min(text.size(), most);
  for (std::size_t i = 1; end < text.size() && i < longest_character; ++i) {
    if (end > 0 && continues(text[end])) --end;
  }
  std::string out;
  for (const char c : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    out += c == '\n' ? ' ' : byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  while (out.ends_with(' ')) out.pop_back();
  return end < text.size() ? out + "…" : out;
}

}  // namespace assay
