#pragma once

#include <string>
#include <string_view>

#include "estimators/core/value.h"

namespace assay::harness {

/// A word of the claim language. `word` includes the parts after dots (`ward.direction.theta`).
struct Token {
  enum class Kind { word, number, symbol, end };
  Kind kind = Kind::end;
  std::string text;
  double number = 0;
  Location where;

  bool is(std::string_view symbol) const { return kind == Kind::symbol && text == symbol; }
  bool is_word(std::string_view word) const { return kind == Kind::word && text == word; }
};

/// "`==`", "the number `3`", "the end of the claim": for messages.
std::string shown(const Token&);

/// Cuts a claim into words, numbers (with their sign), and ( ) , * % == <= >= < > +-.
class Lexer {
 public:
  Lexer(std::string_view text, Location where) : text_(text), where_(std::move(where)) {}

  /// The next token. InputError for an unknown character and for a number that overflows.
  Token next();
  /// The next token, without taking it.
  Token peek() const { return Lexer(*this).next(); }
  /// The text that is not yet taken.
  std::string_view rest() const { return text_.substr(at_); }

 private:
  Token word();
  Token number();
  Token symbol();
  Token taken(Token::Kind kind, std::size_t length);
  bool number_begins() const;
  char ahead(std::size_t offset) const {
    return at_ + offset < text_.size() ? text_[at_ + offset] : '\0';
  }
  Location place() const {
    return {where_.file, where_.line, where_.column + static_cast<int>(at_)};
  }

  std::string_view text_;
  Location where_;
  std::size_t at_ = 0;
};

/// A finite number at the start of `text`, and the number of its characters (0: none).
struct ScannedNumber {
  double value = 0;
  std::size_t length = 0;
  bool overflows = false;
};
ScannedNumber scan_number(std::string_view text);

}  // namespace assay::harness
