#include "reports/words/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace assay::reports {
namespace {

struct Lead {
  std::size_t length;
  char32_t bits;
  char32_t least;  // smaller values would have had a shorter form
};

Lead lead(unsigned char byte) {
  if (byte < 0x80) return {1, byte, 0};
  if (byte >= 0xC2 && byte < 0xE0) return {2, byte & 0x1Fu, 0x80};
  if (byte >= 0xE0 && byte < 0xF0) return {3, byte & 0x0Fu, 0x800};
  if (byte >= 0xF0 && byte < 0xF5) return {4, byte & 0x07u, 0x10000};
  return {0, 0, 0};
}

bool surrogate(char32_t c) { return c >= 0xD800 && c <= 0xDFFF; }

bool non_character(char32_t c) { return (c & 0xFFFE) == 0xFFFE || (c >= 0xFDD0 && c <= 0xFDEF); }

bool control(char32_t c) { return c < 0x20 || (c >= 0x7F && c < 0xA0); }

// Line and paragraph separators, and the controls that reorder what follows them.
bool layout_control(char32_t c) {
  return (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

bool showable(char32_t c) {
  return c == '\n' || c == '\t' || !(control(c) || layout_control(c) || non_character(c));
}

std::string replace(std::string_view text, std::string_view (*form)(char)) {
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  for (const char& c : text) {
    const std::string_view written = form(c);
    result.append(written.empty() ? std::string_view(&c, 1) : written);
  }
  return result;
}

std::string_view xml_form(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

std::string_view white_form(char c) {
  if (c == '\n') return "&#10;";
  return c == '\t' ? std::string_view("&#9;") : std::string_view();
}

// Numeric references also keep GitHub from linking @names and #numbers.
std::string_view markdown_form(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '@':
      return "&#64;";
    case '#':
      return "&#35;";
    case '|':
      return "\\|";
    case '*':
      return "\\*";
    case '_':
      return "\\_";
    case '`':
      return "\\`";
    case '~':
      return "\\~";
    case '[':
      return "\\[";
    case ']':
      return "\\]";
    case '$':
      return "\\$";
    case '\\':
      return "\\\\";
    default:
      return {};
  }
}

}  // namespace

char32_t next_code_point(std::string_view text, std::size_t& position) {
  const std::size_t start = position++;
  const Lead first = lead(static_cast<unsigned char>(text[start]));
  if (first.length == 0 || start + first.length > text.size()) return replacement_character;
  char32_t value = first.bits;
  for (std::size_t i = 1; i < first.length; ++i) {
    const auto byte = static_cast<unsigned char>(text[start + i]);
    if ((byte & 0xC0) != 0x80) return replacement_character;
    value = value << 6 | (byte & 0x3Fu);
  }
  if (value < first.least || value > 0x10FFFF || surrogate(value)) return replacement_character;
  position = start + first.length;
  return value;
}

void append_code_point(std::string& text, char32_t c) {
  const auto byte = [&text](char32_t bits) { text.push_back(static_cast<char>(bits)); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xC0 | c >> 6);
    byte(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    byte(0xE0 | c >> 12);
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  } else {
    byte(0xF0 | c >> 18);
    byte(0x80 | (c >> 12 & 0x3F));
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  }
}

std::string clean(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const char32_t c = next_code_point(text, i);
    if (c == '\r' && i < text.size() && text[i] == '\n') continue;
    append_code_point(result, showable(c) ? c : replacement_character);
  }
  return result;
}

std::string one_line(std::string_view text) {
  std::string result = clean(text);
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return result;
}

std::string escape_xml(std::string_view text) { return replace(clean(text), xml_form); }

std::string escape_attribute(std::string_view text) {
  return replace(escape_xml(text), white_form);
}

std::string escape_markdown(std::string_view text) {
  return replace(one_line(text), markdown_form);
}

std::string cap(std::string text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  const std::string note =
      fmt::format(" [cut: {} bytes in all, the JSON record has them]", text.size());
  std::size_t end = bytes > note.size() ? bytes - note.size() : 0;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  text.resize(end);
  return text + note.substr(0, bytes - end);
}

}  // namespace assay::reports
