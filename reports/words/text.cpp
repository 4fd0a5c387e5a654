#include "reports/words/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

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

/// A character and what is written for it.
struct Form {
  char character;
  std::string_view written;
};

constexpr Form xml_forms[] = {
    {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};

constexpr Form white_forms[] = {{'\n', "&#10;"}, {'\t', "&#9;"}};

// Numeric references also keep GitHub from linking @names and #numbers.
constexpr Form markdown_forms[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'@', "&#64;"},
                                   {'#', "&#35;"}, {'|', "\\|"},  {'*', "\\*"},  {'_', "\\_"},
                                   {'`', "\\`"},   {'~', "\\~"},  {'[', "\\["},  {']', "\\]"},
                                   {'$', "\\$"},   {'\\', "\\\\"}};

std::string replace(std::string_view text, std::span<const Form> forms) {
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  for (const char& c : text) {
    const auto form = std::ranges::find(forms, c, &Form::character);
    result.append(form == forms.end() ? std::string_view(&c, 1) : form->written);
  }
  return result;
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

std::string plain_spaces(std::string text) {
  constexpr std::string_view no_break = "\u00A0";
  for (std::size_t at = 0; (at = text.find(no_break, at)) != std::string::npos;)
    text.replace(at, no_break.size(), " ");
  return text;
}

std::string escape_xml(std::string_view text) { return replace(clean(text), xml_forms); }

std::string escape_attribute(std::string_view text) {
  return replace(escape_xml(text), white_forms);
}

std::string escape_markdown(std::string_view text) {
  return replace(one_line(text), markdown_forms);
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
