#pragma once

// Lines and words of what programs write to each other.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/mapped.h"
#include "estimators/core/quoting.h"
#include "estimators/core/value.h"
#include "estimators/sampler.h"

namespace assay::foreign {

/// The words of a line, which blanks and tabs separate.
inline std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (auto word = take_word(line); !word.empty(); word = take_word(line)) words.push_back(word);
  return words;
}

/// The coordinates that the domain uses: "(0.25, 1)".
inline std::string text_of(const Point& point, Domain domain) {
  return "(" + listed(mapped(std::span(point).first(coordinates(domain)), shortest_text)) + ")";
}

/// The last words of a text, on one line. Cut at a blank, if there is one.
inline std::string last_words(std::string_view text) {
  constexpr std::size_t most = 300;
  std::size_t begin = text.size() > most ? text.size() - most : 0;
  const std::size_t blank = text.find_first_of(" \n", begin);
  if (begin > 0 && blank != std::string::npos) begin = blank;
  const std::string legible = shown(text.substr(begin), 2 * most);
  std::string out;
  for (const std::string_view word : words_of(legible)) out += " " + std::string(word);
  return out.empty() ? "" : (begin > 0 ? " …" : "") + out;
}

/// The end of a sentence on a program: its standard error, "" where that is empty. The last line
/// comes first, because it has the reason.
inline std::string ending_with(std::string_view errors) {
  const std::size_t end = errors.find_last_not_of(" \t\r\n");
  if (end == std::string_view::npos) return "";
  errors = errors.substr(0, end + 1);
  const std::size_t line = errors.rfind('\n') + 1;
  const std::string before = last_words(errors.substr(0, line));
  return "; its standard error ends with:" + last_words(errors.substr(line)) +
         (before.empty() ? "" : "; before that:" + before);
}

}  // namespace assay::foreign
