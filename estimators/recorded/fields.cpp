#include "recorded/fields.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace assay::recorded {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";

bool is_blank(char c) { return blanks.find(c) != blanks.npos; }

/// Calls `visit(i)` for each character outside of quotes until it says true.
template <class Visit>
void outside_quotes(std::string_view line, const Visit& visit) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (!quoted && visit(i)) return;
  }
}

bool is_quoted(std::string_view text) {
  return text.size() > 1 && text.front() == '"' && text.back() == '"';
}

}  // namespace

Field trimmed(std::string_view line, std::size_t begin, std::size_t end) {
  while (begin < end && is_blank(line[begin])) ++begin;
  while (end > begin && is_blank(line[end - 1])) --end;
  return {line.substr(begin, end - begin), static_cast<int>(begin) + 1};
}

std::string_view without_comment(std::string_view line) {
  constexpr std::string_view separators = " \t\r\f\v;,";
  std::size_t end = line.size();
  outside_quotes(line, [&](std::size_t i) {
    const bool begins = i == 0 || separators.find(line[i - 1]) != separators.npos;
    if (line[i] == '#' && begins) end = i;
    return end < line.size();
  });
  return line.substr(0, end);
}

char separator_of(std::string_view line) {
  constexpr std::string_view kinds = ";,\t";
  std::size_t first = kinds.size();
  outside_quotes(line, [&](std::size_t i) {
    first = std::min(first, kinds.find(line[i]));
    return first == 0;
  });
  return first < kinds.size() ? kinds[first] : blank;
}

std::vector<Field> split(std::string_view line, char separator) {
  const std::size_t last = line.find_last_not_of(blanks);
  if (last == line.npos) return {};
  line = line.substr(0, last + 1);
  std::vector<Field> fields;
  std::size_t begin = 0;
  const auto add = [&](std::size_t end) {
    const Field field = trimmed(line, begin, end);
    if (separator != blank || !field.text.empty()) fields.push_back(field);
    begin = end + 1;
  };
  outside_quotes(line, [&](std::size_t i) {
    if (separator == blank ? is_blank(line[i]) : line[i] == separator) add(i);
    return false;
  });
  add(line.size());
  return fields;
}

std::string unquoted(std::string_view text) {
  if (!is_quoted(text)) return std::string(text);
  std::string inside;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    inside += text[i];
    if (text[i] == '"') ++i;
  }
  return inside;
}

Parsed parse(std::string_view text, bool decimal_comma) {
  if (is_quoted(text)) text = text.substr(1, text.size() - 2);
  std::string pointed;
  if (decimal_comma && text.find('.') == text.npos && std::ranges::count(text, ',') == 1) {
    pointed = text;
    pointed[pointed.find(',')] = '.';
    text = pointed;
  }
  // from_chars knows no plus sign; "+-1" stays junk.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Parsed parsed;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, parsed.value);
  parsed.is_number = problem == std::errc{} && stop == end;
  parsed.out_of_range = problem == std::errc::result_out_of_range && stop == end;
  return parsed;
}

bool is_missing(std::string_view text) {
  constexpr std::array words{"NA", "N/A", "n/a", "<NA>", "null", "NULL", "None", "-"};
  return std::ranges::find(words, text) != words.end();
}

bool may_be_name(const Field& field) {
  const bool numeric = std::string_view("0123456789+-.").find(field.text[0]) != std::string::npos;
  return !numeric && !is_missing(field.text) && !parse(field.text, false).is_number &&
         (field.text[0] != '"' || is_quoted(field.text));
}

}  // namespace assay::recorded
