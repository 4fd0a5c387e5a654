#include "harness/base/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "harness/base/refuse.h"
#include "reports/words/text.h"

namespace assay::harness {

namespace {

constexpr std::size_t largest_file = std::size_t{16} << 20;
constexpr std::size_t shown_bytes = 72;

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80; }

}  // namespace

std::string read_text_file(const std::string& file) {
  const auto fail = [&](const std::string& why) { refuse({}, "cannot read `{}`: {}", file, why); };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) fail("it is a folder; name the files in it");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in && errno == ENOENT) fail("there is no such file" + near_file(file));
  if (!in) fail(errno ? std::strerror(errno) : "it cannot be opened");
  std::string text;
  std::array<char, 65536> chunk{};
  while (text.size() <= largest_file && (in.read(chunk.data(), chunk.size()) || in.gcount() > 0)) {
    text.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) fail("reading it failed");
  if (text.size() > largest_file) fail("it is larger than 16 MiB");
  return text;
}

std::optional<std::string> bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return std::move(bytes).str();
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
    std::size_t next = i;
    const char32_t read = reports::next_code_point(text, next);
    const bool invalid = read == reports::replacement_character && next == i + 1;
    const unsigned byte = static_cast<unsigned char>(text[i]);
    const bool space = byte == '\t' || byte == '\n' || byte == '\r';
    if (invalid || (byte < 0x20 && !space) || byte == 0x7F) {
      const char* why = invalid ? "is not UTF-8" : "is a control character";
      refuse({file, line, static_cast<int>(i - start) + 1},
             "the byte 0x{:02x} {}; save the file as UTF-8 text", byte, why);
    }
    i = next;
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
