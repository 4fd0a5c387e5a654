#include "harness/language/claim_lexer.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace assay::harness {

namespace {

/// Longest exponent with its sign; without a limit `0e99999999999` would be read as a number.
constexpr std::size_t longest_exponent = 6;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool continues_word(char c) { return is_letter(c) || is_digit(c) || c == '-' || c == '/'; }

}  // namespace

ScannedNumber scan_number(std::string_view text) {
  const std::size_t plus = text.starts_with('+') ? 1 : 0;
  const std::size_t sign = plus == 1 || text.starts_with('-') ? 1 : 0;
  // from_chars would also read `inf` and `nan`.
  if (text.size() <= sign || (!is_digit(text[sign]) && text[sign] != '.')) return {};
  ScannedNumber found;
  const char* const begin = text.data() + plus;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), found.value);
  if (error == std::errc::invalid_argument) return {};
  found.length = static_cast<std::size_t>(end - text.data());
  const std::size_t e = text.substr(0, found.length).find_first_of("eE");
  const bool absurd = e != std::string_view::npos && found.length - e - 1 > longest_exponent;
  found.overflows = error != std::errc{} || !std::isfinite(found.value) || absurd;
  return found;
}

std::string shown(const Token& token) {
  switch (token.kind) {
    case Token::Kind::end:
      return "the end";
    case Token::Kind::number:
      return fmt::format("the number `{}`", token.text);
    case Token::Kind::word:
    case Token::Kind::symbol:
      return fmt::format("`{}`", token.text);
  }
  return "";
}

Token Lexer::next() {
  while (is_blank(ahead(0))) ++at_;
  if (at_ == text_.size()) return taken(Token::Kind::end, 0);
  if (is_letter(ahead(0))) return word();
  if (number_begins()) return number();
  return symbol();
}

Token Lexer::taken(Token::Kind kind, std::size_t length) {
  Token token{.kind = kind, .text = std::string(text_.substr(at_, length)), .where = place()};
  at_ += length;
  return token;
}

Token Lexer::word() {
  std::size_t length = 1;
  while (continues_word(ahead(length)) ||
         (ahead(length) == '.' && continues_word(ahead(length + 1)))) {
    ++length;
  }
  return taken(Token::Kind::word, length);
}

bool Lexer::number_begins() const {
  std::size_t i = ahead(0) == '-' || ahead(0) == '+' ? 1 : 0;
  if (ahead(i) == '.') ++i;
  return is_digit(ahead(i));
}

Token Lexer::number() {
  const ScannedNumber found = scan_number(rest());
  const Location where = place();
  Token token = taken(Token::Kind::number, found.length);
  token.number = found.value;
  if (found.overflows) {
    throw InputError(where, fmt::format("the number `{}` does not fit a double", token.text));
  }
  return token;
}

Token Lexer::symbol() {
  for (const std::string_view known : {"==", "<=", ">=", "+-", "<", ">", "(", ")", ",", "*", "%"}) {
    if (rest().starts_with(known)) return taken(Token::Kind::symbol, known.size());
  }
  struct Habit {
    std::string_view written, advice;
  };
  static constexpr std::string_view no_arithmetic =
      "a claim has no arithmetic; compare two quantities, as in `mean(a) == mean(b)` or "
      "`mean(a) == 2 * mean(b)`";
  static constexpr std::array habits{
      Habit{"!=", "a claim cannot be `!=`; claim `==` and expect it to fail, or claim `<` or `>`"},
      Habit{"~", "write `==`, or `within 1% of` for what need only be close"},
      Habit{"=", "a lone `=`; did you mean `==`?"},
      Habit{"±", "write `+-` for `±`"},
      Habit{"≤", "write `<=` for `≤`"},
      Habit{"≥", "write `>=` for `≥`"},
      Habit{"\"", "no quotes inside a claim"},
      Habit{"'", "no quotes inside a claim"},
      Habit{"-", no_arithmetic},
      Habit{"+", no_arithmetic},
      Habit{"/", no_arithmetic},
      Habit{".", "the name of a part must follow the `.` at once"},
  };
  for (const Habit& habit : habits) {
    if (rest().starts_with(habit.written)) throw InputError(place(), std::string(habit.advice));
  }
  std::size_t length = 1;
  while ((static_cast<unsigned char>(ahead(length)) & 0xC0U) == 0x80) ++length;
  throw InputError(place(),
                   fmt::format("`{}` has no meaning in a claim", rest().substr(0, length)));
}

}  // namespace assay::harness
