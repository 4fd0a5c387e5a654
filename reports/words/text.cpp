#include "reports/words/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/split.hpp>
#include <boost/locale/utf.hpp>
#include <cctype>
#include <iterator>

namespace assay::reports {
namespace {

using Utf8 = boost::locale::utf::utf_traits<char>;

struct Range {
  char32_t first, last;
};

bool within(std::span<const Range> ranges, char32_t c) {
  return std::ranges::any_of(ranges, [c](Range r) { return c >= r.first && c <= r.last; });
}

// These are never shown: controls but for tab and line feed, separators of lines and paragraphs,
// controls that reorder what follows them, and non-characters.
constexpr Range hidden[] = {{0x00, 0x08},     {0x0B, 0x1F},     {0x7F, 0x9F},
                            {0x2028, 0x202E}, {0x2066, 0x2069}, {0xFDD0, 0xFDEF}};

bool showable(char32_t c) { return !within(hidden, c) && (c & 0xFFFE) != 0xFFFE; }

constexpr Form xml_forms[] = {
    {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};

constexpr Form white_forms[] = {{'\n', "&#10;"}, {'\t', "&#9;"}};

// Numeric references also keep GitHub from linking @names and #numbers.
constexpr Form markdown_forms[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'@', "&#64;"},
                                   {'#', "&#35;"}, {'|', "\\|"},  {'*', "\\*"},  {'_', "\\_"},
                                   {'`', "\\`"},   {'~', "\\~"},  {'[', "\\["},  {']', "\\]"},
                                   {'$', "\\$"},   {'\\', "\\\\"}};

constexpr Range combining[] = {{0x0300, 0x036F}, {0x1AB0, 0x1ACE}, {0x1DC0, 0x1DFF},
                               {0x200B, 0x200F}, {0x20D0, 0x20F0}, {0xFE00, 0xFE0F}};

// Supersets of Unicode's East Asian Width W and F: counting too many columns is harmless.
constexpr Range wide[] = {
    {0x1100, 0x115F}, {0x231A, 0x231B}, {0x2329, 0x232A},   {0x23E9, 0x23FF},
    {0x25FD, 0x26FF}, {0x2705, 0x27BF}, {0x2B1B, 0x2B55},   {0x2E80, 0xA4CF},
    {0xA960, 0xA97C}, {0xAC00, 0xD7FF}, {0xF900, 0xFAFF},   {0xFE10, 0xFE6F},
    {0xFF01, 0xFF60}, {0xFFE0, 0xFFE6}, {0x16FE0, 0x1FFFF}, {0x20000, 0x3FFFF}};

// The longest start of the text that fits, and its columns.
std::size_t fitting(std::string_view text, int width) {
  int used = 0;
  std::size_t position = 0;
  while (position < text.size()) {
    std::size_t next = position;
    used += columns(next_code_point(text, next));
    if (used > width) break;
    position = next;
  }
  return position;
}

// The last place up to `end` where a long word, such as a claim, may be parted; else `end`.
std::size_t joint(std::string_view text, std::size_t end) {
  for (std::size_t i = end; i > end / 2; --i) {
    const char last = text[i - 1];
    const bool letter = std::isalpha(static_cast<unsigned char>(text[i])) != 0;
    if (last == '(' || last == ',' || last == '/' || (last == '.' && letter)) return i;
  }
  return end;
}

/// A blank parts words, the words of a command in backticks, or nothing.
enum class Blank { words, command, nothing };

Blank blank_at(std::string_view text, std::size_t at) {
  if (text[at] != ' ' || text.substr(at).starts_with(" %")) return Blank::nothing;
  const std::size_t begin = text.rfind("`assay ", at);
  const std::size_t end = begin == text.npos ? begin : text.find('`', begin + 1);
  if (end == text.npos || end < at) return Blank::words;
  bool in_quotes = false;
  for (std::size_t i = begin + 1; i < at; ++i) {
    if (text[i] == '\'' && text[i - 1] != '\\') in_quotes = !in_quotes;
  }
  return in_quotes ? Blank::nothing : Blank::command;
}

// Takes the next line off the front of `rest`, the end of `text`. A line that ends within a command
// says so as a shell wants it.
std::string take_line(std::string_view text, std::string_view& rest, int width) {
  std::size_t end = fitting(rest, width);
  std::size_t next = end;
  bool goes_on = false;
  const std::size_t start = text.size() - rest.size();
  const auto last = [&](std::size_t at, Blank kind) {
    while (at > 0 && blank_at(text, start + at) != kind) --at;
    return at;
  };
  if (end < rest.size() && blank_at(text, start + end) != Blank::words) {
    std::size_t space = last(end, Blank::words);
    if (space == 0) {
      space = last(fitting(rest, width - 2), Blank::command);
      goes_on = space > 0;
    }
    end = next = space > 0 ? space : joint(rest, end);
  }
  while (next < rest.size() && rest[next] == ' ') ++next;
  std::string line(rest.substr(0, end));
  rest.remove_prefix(next);
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return goes_on ? line + " \\" : line;
}

std::vector<std::string> words_outside_quotes(std::string_view command) {
  std::vector<std::string> words(1);
  char quote = 0;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    if (quote == 0 && c == ' ') {
      words.emplace_back();
      continue;
    }
    words.back() += c;
    if (c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (quote == 0 && c == '\\' && i + 1 < command.size()) {
      words.back() += command[++i];
    }
  }
  std::erase(words, "");
  return words;
}

}  // namespace

char32_t next_code_point(std::string_view text, std::size_t& position) {
  const char* const start = text.data() + position;
  const char* end = start;
  const boost::locale::utf::code_point c = Utf8::decode(end, text.data() + text.size());
  const bool valid = boost::locale::utf::is_valid_codepoint(c);
  position += valid ? static_cast<std::size_t>(end - start) : 1;
  return valid ? c : replacement_character;
}

void append_code_point(std::string& text, char32_t c) { Utf8::encode(c, std::back_inserter(text)); }

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
  std::ranges::replace_if(result, boost::is_any_of("\n\t"), ' ');
  return result;
}

std::string plain_spaces(std::string text) {
  boost::replace_all(text, "\u00A0", " ");
  return text;
}

std::string escape(std::string_view text, std::span<const Form> forms) {
  std::string result;
  for (const char& c : text) {
    const auto form = std::ranges::find(forms, c, &Form::character);
    result.append(form == forms.end() ? std::string_view(&c, 1) : form->written);
  }
  return result;
}

std::string escape_xml(std::string_view text) { return escape(clean(text), xml_forms); }

std::string escape_attribute(std::string_view text) {
  return escape(escape_xml(text), white_forms);
}

std::string escape_markdown(std::string_view text) {
  return escape(one_line(text), markdown_forms);
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

int columns(char32_t c) {
  if (within(combining, c)) return 0;
  // The marks of the verdicts lie in a range that is otherwise wide.
  const bool is_mark = c == 0x2713 || c == 0x2717;
  return within(wide, c) && !is_mark ? 2 : 1;
}

int columns(std::string_view text) {
  int sum = 0;
  for (std::size_t i = 0; i < text.size();) sum += columns(next_code_point(text, i));
  return sum;
}

std::string shorten(std::string_view text, int width) {
  if (columns(text) <= width) return std::string(text);
  if (width < 1) return {};
  return std::string(text.substr(0, fitting(text, width - 1))) + "…";
}

std::string pad_right(std::string text, int width) {
  const int missing = width - columns(text);
  if (missing > 0) text.append(static_cast<std::size_t>(missing), ' ');
  return text;
}

std::string in_single_quotes(const std::string& text) {
  return "'" + boost::replace_all_copy(text, "'", "'\\''") + "'";
}

std::vector<std::string> wrap(std::string_view text, int width) {
  width = std::max(width, 2);
  std::vector<std::string> paragraphs, lines;
  boost::split(paragraphs, text, boost::is_any_of("\n"));
  for (std::string& paragraph : paragraphs) {
    std::ranges::replace(paragraph, '\t', ' ');
    std::string_view rest = paragraph;
    do lines.push_back(take_line(paragraph, rest, width));
    while (!rest.empty());
  }
  return lines;
}

std::vector<std::string> wrap_command(std::string_view command, int width) {
  width = std::max(width, 4);
  std::vector<std::string> lines(1);
  std::vector<std::string> pieces;  // an option with its value is one
  for (const std::string& word : words_outside_quotes(command)) {
    const bool is_value = !pieces.empty() && pieces.back().starts_with("--") &&
                          pieces.back().find(' ') == std::string::npos && !word.starts_with('-') &&
                          columns(pieces.back() + " " + word) <= width - 2;
    if (is_value) {
      pieces.back() += " " + word;
    } else {
      pieces.push_back(word);
    }
  }
  for (const std::string& word : pieces) {
    const int used = columns(lines.back());
    if (used > 0 && used + 1 + columns(word) > width - 2) {
      lines.back() += " \\";
      lines.emplace_back();
    }
    if (!lines.back().empty()) lines.back() += ' ';
    lines.back() += word;
  }
  return lines;
}

}  // namespace assay::reports
