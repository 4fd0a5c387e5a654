#include "harness/base/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "reports/words/text.h"

namespace assay::harness {

namespace {

constexpr std::size_t largest_file = std::size_t{16} << 20;
constexpr std::size_t shown_bytes = 72;

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80; }

/// The length in bytes of the UTF-8 sequence at the start of `text`; 0 if it is invalid by RFC
/// 3629.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!continues(text[i])) return 0;
  }
  const unsigned second = byte(1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || outside ? 0 : length;
}

bool forbidden_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
}

/// "; did you mean …?" of a file beside it, or "".
std::string near_file(const std::string& file) {
  namespace fs = std::filesystem;
  const fs::path path(file);
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& each :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", ignored)) {
    if (each.is_regular_file(ignored)) names.push_back(each.path().filename().string());
  }
  const std::string near = nearest(path.filename().string(), names);
  if (near.empty()) return "";
  return fmt::format("; did you mean `{}`?", (path.parent_path() / near).string());
}

}  // namespace

std::string read_text_file(const std::string& file) {
  const auto refuse = [&](const std::string& why) {
    throw InputError({}, fmt::format("cannot read `{}`: {}", file, why));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) refuse("it is a folder; name the files in it");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in && errno == ENOENT) refuse("there is no such file" + near_file(file));
  if (!in) refuse(errno ? std::strerror(errno) : "it cannot be opened");
  std::string text;
  std::array<char, 65536> chunk{};
  while (text.size() <= largest_file && (in.read(chunk.data(), chunk.size()) || in.gcount() > 0)) {
    text.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) refuse("reading it failed");
  if (text.size() > largest_file) refuse("it is larger than 16 MiB");
  return text;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

void require_utf8(std::string_view text, const std::string& file) {
  int line = 1;
  std::size_t start = 0;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_length(text.substr(i));
    if (length == 0 || forbidden_control(text[i])) {
      const unsigned byte = static_cast<unsigned char>(text[i]);
      const char* why = length == 0 ? "is not UTF-8" : "is a control character";
      throw InputError({file, line, static_cast<int>(i - start) + 1},
                       fmt::format("the byte 0x{:02x} {}; save the file as UTF-8 text", byte, why));
    }
    i += length;
    if (text[i - 1] == '\n') {
      ++line;
      start = i;
    }
  }
}

std::string caret_below(std::string_view line, int column) {
  const std::size_t at = std::min(static_cast<std::size_t>(std::max(column, 1)) - 1, line.size());
  std::size_t begin = at > shown_bytes - 20 ? at - (shown_bytes - 20) : 0;
  while (begin > 0 && begin < at && continues(line[begin])) ++begin;
  std::size_t end = std::min(begin + shown_bytes, line.size());
  while (end > at && end < line.size() && continues(line[end])) --end;
  const std::string head = begin > 0 ? "..." : "";
  // Control characters become one character each, so that the caret stays below its column.
  const std::string before = reports::clean(line.substr(begin, at - begin));
  std::string out = "  " + head + before + reports::clean(line.substr(at, end - at));
  if (end < line.size()) out += "...";
  out += "\n  " + std::string(head.size(), ' ');
  for (const char c : before) {
    if (!continues(c)) out += c == '\t' ? '\t' : ' ';
  }
  return out + "^\n";
}

}  // namespace assay::harness
