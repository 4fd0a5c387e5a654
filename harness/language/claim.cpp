#include "harness/language/claim.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/trim.hpp>
#include <charconv>
#include <cmath>
#include <numbers>
#include <ranges>

#include "harness/language/laws.h"

namespace assay::harness {
namespace {

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

/// "`==`", "the number `3`", "the end": for messages.
std::string shown(const Token& token) {
  if (token.kind == Token::Kind::end) return "the end";
  return fmt::format("{}`{}`", token.kind == Token::Kind::number ? "the number " : "", token.text);
}

/// Longest exponent with its sign; without a limit `0e99999999999` would be read as a number.
constexpr std::size_t longest_exponent = 6;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool continues_word(char c) { return is_letter(c) || is_digit(c) || c == '-' || c == '/'; }

/// A finite number at the start of `text`, and the number of its characters (0: none).
struct ScannedNumber {
  double value = 0;
  std::size_t length = 0;
  bool overflows = false;
};
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

std::vector<std::string> quantity_words() { return mapped(quantities(), &QuantityRow::word); }

/// Cuts a claim into words, numbers (with their sign), and ( ) , * % == <= >= < > +-.
class Lexer {
 public:
  Lexer(std::string_view text, Location where) : text_(text), where_(std::move(where)) {}

  /// The next token. InputError for an unknown character and for a number that overflows.
  Token next() {
    while (is_blank(ahead(0))) ++at_;
    if (at_ == text_.size()) return taken(Token::Kind::end, 0);
    if (is_letter(ahead(0))) return word();
    const ScannedNumber found = scan_number(rest());
    return found.length > 0 ? number(found) : symbol();
  }

  Token peek() const { return Lexer(*this).next(); }

 private:
  Token taken(Token::Kind kind, std::size_t length) {
    Token token{.kind = kind, .text = std::string(text_.substr(at_, length)), .where = place()};
    at_ += length;
    return token;
  }

  Token word() {
    std::size_t length = 1;
    while (continues_word(ahead(length)) ||
           (ahead(length) == '.' && continues_word(ahead(length + 1)))) {
      ++length;
    }
    return taken(Token::Kind::word, length);
  }

  Token number(const ScannedNumber& found) {
    Token token = taken(Token::Kind::number, found.length);
    token.number = found.value;
    if (found.overflows) refuse(token.where, "the number `{}` does not fit a double", token.text);
    if (divisor() == 0) return token;
    refuse(token.where, "a claim has no arithmetic; write the quotient as one number, `{}`",
           token.number / divisor());
  }

  /// The number after a `/` that comes next; 0 without one.
  double divisor() const {
    Lexer after = *this;
    while (is_blank(after.ahead(0))) ++after.at_;
    if (after.ahead(0) != '/') return 0;
    do ++after.at_;
    while (is_blank(after.ahead(0)));
    return scan_number(after.rest()).value;
  }

  Token symbol() {
    for (const std::string_view known :
         {"===", "+/-", "==", "=<", "=>", "<=", ">=", "+-", "<", ">", "(", ")", ",", "*", "%"}) {
      if (rest().starts_with(known)) return taken(Token::Kind::symbol, known.size());
    }
    static constexpr std::string_view no_arithmetic =
        "a claim has no arithmetic; compare two quantities, as in `mean(a) == mean(b)` or `mean(a) "
        "== 2 * mean(b)`";
    static constexpr std::pair<std::string_view, std::string_view> habits[]{
        {"!=", "a claim cannot be `!=`; claim `==` and expect it to fail, or claim `<` or `>`"},
        {"&", "write two tests, or `mean(a) within 0.05 of 0.45`"},
        {"^", "a claim has no powers; compare squares, as `variance(…)`, or write a number"},
        {"~", "write `==`, or `within 1% of` for near values"},
        {"=", "a lone `=`; did you mean `==`?"},
        {"±", "write `+-` for `±`"},
        {"≤", "write `<=` for `≤`"},
        {"≥", "write `>=` for `≥`"},
        {"\"", "no quotes inside a claim"},
        {"'", "no quotes inside a claim"},
        {"-", no_arithmetic},
        {"+", no_arithmetic},
        {"/", no_arithmetic},
        {".",
         "the name of a part must follow the `.` at once; a file is read by an estimator of "
         "the plugin `recorded`"},
    };
    const std::string before = boost::trim_copy(std::string(text_.substr(0, at_)));
    const std::string divided = boost::trim_copy(before.substr(before.find_last_of("=<>") + 1));
    // A quantity by itself can have the factor.
    if (std::isfinite(1 / divisor()) && divided.size() < before.size() && before.ends_with(')') &&
        std::ranges::count(quantity_words(), divided.substr(0, divided.find('('))) > 0) {
      refuse(place(), "a claim has no arithmetic; a factor stands on the right: `{} * {}`",
             1 / divisor(), divided);
    }
    for (const auto& [written, advice] : habits) {
      if (rest().starts_with(written)) refuse(place(), std::string(advice));
    }
    std::size_t length = 1;
    while ((static_cast<unsigned char>(ahead(length)) & 0xC0U) == 0x80) ++length;
    refuse(place(), "`{}` has no meaning in a claim{}", rest().substr(0, length),
           length > 1 ? "; a name has letters from a to z, digits, `_`, `-` and `/`" : "");
  }

  /// The text that is not yet taken.
  std::string_view rest() const { return text_.substr(at_); }
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

using Kind = Token::Kind;

Source source_of(const Token& word) {
  const std::size_t dot = std::min(word.text.find('.'), word.text.size());
  return {.estimator = word.text.substr(0, dot),
          .part = word.text.substr(std::min(dot + 1, word.text.size())),
          .where = word.where};
}

class Parser {
 public:
  Parser(std::string_view text, const Location& where) : lexer_(text, where) {}

  Claim claim() {
    Claim claim;
    if (const Token token = lexer_.peek(); token.kind == Kind::number) {
      refuse(token.where,
             "a claim begins with a quantity, as in `mean(a) < 2 * mean(b)`; a range is `mean(a) "
             "within 0.05 of 0.45`");
    }
    claim.left = quantity();
    relation(claim);
    claim.right = side();
    end("the claim");
    return claim;
  }

  Source source() {
    const Source found = source_of(expect_word("an estimator"));
    end("the source");
    return found;
  }

  std::variant<Source, Constant> reference() {
    if (lexer_.peek().kind != Kind::number) return source();
    const Constant found = constant(lexer_.next().number);
    end("the reference");
    return found;
  }

  Margin margin() {
    const Token token = expect(Kind::number, "a margin, as `0.5%` or `0.002`");
    Margin margin{.value = token.number, .relative = take("%"), .where = token.where};
    if (margin.relative) margin.value = percent(token);
    if (margin.value < 0) refuse(token.where, "a margin cannot be negative");
    return margin;
  }

  void end(const char* what) {
    const Token token = lexer_.next();
    if (token.kind == Kind::end) return;
    const bool factor = token.is_word("x") || find_quantity(token.text) != nullptr;
    const std::string meaning = meaning_of(factor ? "*" : token.text);
    refuse(token.where, "{} ends before {}{}", what, shown(token), meaning);
  }

 private:
  /// A hundredth of a decimal number, rounded once: 0.1% is the double nearest to 0.001.
  static double percent(const Token& token) {
    const std::size_t e = std::min(token.text.find_first_of("eE"), token.text.size());
    const std::string exponent = token.text.substr(std::min(e + 1, token.text.size()));
    const int shifted = (exponent.empty() ? 0 : std::stoi(exponent)) - 2;
    return scan_number(token.text.substr(0, e) + "e" + std::to_string(shifted)).value;
  }

  Quantity quantity() {
    const Token name = expect_word("a quantity (mean, variance, distribution …)");
    if (name.text == "slope") return slope(name);
    const QuantityRow* const known = find_quantity(name.text);
    if (known == nullptr) no_quantity(name);
    Quantity quantity{.row = known, .where = name.where};
    expect("(", fmt::format("`(` after `{}`", name.text));
    quantity.source = source_of(expect_word("the name of an estimator"));
    while (take(",")) quantity.arguments.push_back(expect_number());
    if (lexer_.peek().is("%")) refuse(lexer_.peek().where, "a probability is a number, as `0.9`");
    expect(")", "`)` or `,`");
    return quantity;
  }

  Quantity slope(const Token& name) {
    expect("(", "`(` after `slope`");
    if (lexer_.peek().is_word("slope")) refuse(lexer_.peek().where, "a slope has no slope");
    Quantity quantity = this->quantity();
    quantity.slope = true;
    quantity.where = name.where;
    expect(")", "`)`");
    return quantity;
  }

  void relation(Claim& claim) {
    const Token token = lexer_.next();
    for (const Relation known : {Relation::equal, Relation::at_most, Relation::at_least,
                                 Relation::less, Relation::greater}) {
      if (token.is(to_string(known))) {
        claim.relation = known;
        return;
      }
    }
    if (token.kind == Kind::end) {
      refuse(token.where, "the claim is not complete: add `== analytic`, `<= 0.5`, …");
    }
    if (!token.is_word("within")) {
      const std::string hint = meaning_of(token.text);
      unexpected(token, "`==`, `<=`, `>=`, `<`, `>` or `within … of`",
                 hint.empty() ? did_you_mean(token.text, {"within"}) : hint);
    }
    claim.relation = Relation::within;
    claim.margin = margin();
    const Token of = lexer_.next();
    if (!of.is_word("of")) unexpected(of, "`of` after the margin");
  }

  Side side() {
    const Token token = lexer_.peek();
    if (token.kind == Kind::number) return number_side();
    if (token.kind != Kind::word) unexpected(token, expected_side);
    if (token.text == "slope" || find_quantity(token.text) != nullptr)
      return ScaledQuantity{1, quantity()};
    lexer_.next();
    if (token.text == "analytic") return Analytic{};
    if (token.text == "density" || find_law(token.text)) return law(token);
    refuse(token.where, "a quantity cannot be compared with `{}`{}", token.text,
           side_advice(token));
  }

  Side number_side() {
    const double number = lexer_.next().number;
    if (take("*")) {
      const Token factor = lexer_.peek();
      const bool is_pi = factor.is_word("pi");
      if (is_pi || factor.kind == Kind::number) {
        refuse(factor.where, "a claim has no arithmetic; write the product as one number, `{}`",
               number * (is_pi ? std::numbers::pi : factor.number));
      }
      return ScaledQuantity{number, quantity()};
    }
    if (const Token token = lexer_.peek(); token.is("%")) {
      refuse(
          token.where,
          "a value has no per cent: write `{:g}`, or a margin, as in `mean(a) within {:g}% of 0.5`",
          number / 100, number);
    }
    return constant(number);
  }

  /// A number that is read, and its standard error if that follows.
  Constant constant(double number) {
    if (!take("+-")) return {number, 0};
    const Location where = lexer_.peek().where;
    const double error = expect_number();
    if (error < 0) refuse(where, "a standard error cannot be negative");
    if (const Token token = lexer_.peek(); token.is("%")) {
      refuse(token.where, "a standard error is a number: write `{0} +- {1:.6g}`", number,
             std::abs(number * error / 100));
    }
    return {number, error};
  }

  Law law(const Token& name) {
    Law law{.name = name.text, .where = name.where};
    if (!lexer_.peek().is("(")) return law;
    if (name.text == "density") refuse(lexer_.peek().where, "`density` takes no numbers");
    lexer_.next();
    do law.arguments.push_back(expect_number());
    while (take(","));
    expect(")", "`)` or `,`");
    return law;
  }

  /// Says what to write for a word or symbol of another notation, or in a wrong place; may be "".
  static std::string meaning_of(std::string_view word) {
    const std::string alone = fmt::format(" {} ", word);
    for (const auto& [words, advice] :
         std::initializer_list<std::pair<std::string_view, const char*>>{
             {" E average avg expectation expected ", "; did you mean `mean(…)`?"},
             {" stddev stdev std deviation standard_deviation sd ", "; square it: `variance(…)`"},
             {" sqrt ", "; compare squares, as `variance(…)`, or write the root as a number"},
             {" and AND ", "; write two tests, or `mean(a) within 0.05 of 0.45`"},
             {" error mse rmse MSE RMSE ", "; it has two parts: `bias(…)` and `variance(…)`"},
             {" median ", "; it is a quantile: `quantile(…, 0.5)`"},
             {" pi PI Pi ", "; write it as a number, 3.141592653589793"},
             {" pdf ", "; did you mean `density`?"},
             {" gaussian ", "; did you mean `normal(0, 1)`?"},
             {" === ", "; did you mean `==`?"},
             {" =< ", "; did you mean `<=`?"},
             {" => ", "; did you mean `>=`?"},
             {" +/- ", "; did you mean `+-`?"},
             {" * ", "; a factor stands before its quantity: `0.5 * mean(b)`"},
             {" , ", "; write decimals after a point"},
             {" +- ", ", which follows a number: `0.5 +- 0.01`"},
             {" within ", ", which replaces the relation: `mean(a) within 1% of 0.5`"}}) {
      if (words.find(alone) != words.npos) return advice;
    }
    return "";
  }

  /// The commonest mistakes: an estimator without a quantity, and exchanged sides.
  [[noreturn]] void no_quantity(const Token& name) {
    std::string near = meaning_of(name.text);
    if (near.empty()) near = did_you_mean(name.text, quantity_words());
    const bool stands_on_the_right =
        name.text == "analytic" || name.text == "density" || find_law(name.text);
    if (near.empty() && stands_on_the_right) {
      refuse(name.where,
             "`{}` stands on the right, as in `mean(area) == analytic` or `distribution(x) == "
             "normal(0, 1)`",
             name.text);
    }
    if (near.empty() && !lexer_.peek().is("(")) {
      refuse(name.where, "expected a quantity, as in `mean({0})`, found `{0}`", name.text);
    }
    if (near.empty()) near = "; expected one of " + listed(quantity_words());
    refuse(name.where, "there is no quantity `{}`{}", name.text, near);
  }

  std::string side_advice(const Token& token) {
    std::vector<std::string> words = quantity_words();
    words.insert(words.end(), {"analytic", "density"});
    for (const LawInformation& law : laws()) words.push_back(law.name);
    if (token.text.starts_with("pi/")) return "; a claim has no arithmetic: write the number";
    std::string near = meaning_of(token.text);
    if (near.empty()) near = did_you_mean(token.text, words);
    if (!near.empty()) return near;
    // `mean(a) == b`: an estimator without a quantity.
    if (!lexer_.peek().is("(")) {
      return fmt::format("; of an estimator, write its quantity, as in `mean({})`", token.text);
    }
    return fmt::format("; expected {}", expected_side);
  }

  bool take(std::string_view symbol) {
    const bool is_next = lexer_.peek().is(symbol);
    if (is_next) lexer_.next();
    return is_next;
  }

  void expect(std::string_view symbol, const std::string& expected) {
    const Token token = lexer_.next();
    if (!token.is(symbol)) unexpected(token, expected);
  }

  Token expect(Kind kind, const char* expected) {
    Token token = lexer_.next();
    if (token.kind != kind) unexpected(token, expected);
    return token;
  }
  Token expect_word(const char* expected) { return expect(Kind::word, expected); }
  double expect_number() { return expect(Kind::number, "a number").number; }

  [[noreturn]] static void unexpected(const Token& token, const std::string& expected,
                                      const std::string& hint = "") {
    refuse(token.where, "expected {}, found {}{}", expected, shown(token), hint);
  }

  static constexpr const char* expected_side =
      "a number, `analytic`, a quantity as `mean(…)`, or a law as `uniform(0, 1)` (`assay list "
      "laws`)";

  Lexer lexer_;
};

void check_quantity(const Quantity& q) {
  if (!q.row->of_a_probability && !q.arguments.empty()) {
    refuse(q.where, "`{}` takes an estimator alone; only `quantile` has a number", q.row->word);
  }
  const bool has_probability = q.arguments.size() == 1 && q.arguments[0] > 0 && q.arguments[0] < 1;
  if (q.row->of_a_probability && !has_probability) {
    refuse(q.where,
           "`quantile` takes an estimator and one probability between 0 and 1: `quantile(x, 0.5)`");
  }
  if (q.row->over_all_channels && !q.source.part.empty()) {
    refuse(q.source.where, "`{}` is over all channels; name the estimator alone, or use `variance`",
           q.row->word);
  }
  if (q.slope && q.row->slope == nullptr) {
    auto sloped = quantities() | std::views::filter(&QuantityRow::slope);
    refuse(q.where, "`slope` takes a {}, not `{}`",
           listed(mapped(sloped, &QuantityRow::word), " or "), q.row->word);
  }
}

void check_side(const Claim& claim, const ScaledQuantity& side) {
  const Quantity& q = side.quantity;
  check_quantity(q);
  const Quantity& left = claim.left;
  if (left.slope || q.slope) refuse(q.where, "a slope is compared with a number");
  if (left.row->of_a_sampler) refuse(q.where, "`{}` is compared with a number", left.row->word);
  if (q.row != left.row) {
    refuse(q.where,
           "`{}` on the left cannot be compared with `{}`; both sides must be the same quantity",
           left.row->word, q.row->word);
  }
  if (side.factor == 1) return;
  if (q.row->of_a_law) refuse(q.where, "a distribution cannot be multiplied");
  if (side.factor == 0)
    refuse(q.where, "a factor of 0 leaves nothing to compare; give the number itself");
  if (q.row->never_negative() && side.factor < 0) {
    refuse(q.where, "`{}` is never negative; the factor must be above 0", q.row->word);
  }
}

void check_side(const Claim& claim, const Constant& side) {
  const Quantity& left = claim.left;
  if (left.row->of_a_law) {
    refuse(left.where, "a distribution is compared with `density`, a law or another distribution");
  }
  if (side.standard_error > 0 && (left.slope || !left.row->takes_standard_error)) {
    refuse(left.where, "`{}` is compared with an exact number: no method takes `+-` here",
           left.slope ? "slope" : left.row->word);
  }
  if (left.row->never_negative() && !left.slope && side.value < 0) {
    refuse(left.where, "`{}` is never negative, but it is compared with {}", left.row->word,
           side.value);
  }
  if (left.row->tested_as_a_ratio && !left.slope && side.value == 0) {
    refuse(left.where, "`{}` is tested as a ratio: give a number above 0", left.row->word);
  }
}

void check_side(const Claim& claim, const Analytic&) {
  const Quantity& left = claim.left;
  if (left.slope || left.row->analytic == nullptr) {
    refuse(left.where, "`analytic` is a mean or a variance, which `{}` does not have{}",
           left.slope ? "slope" : left.row->word.c_str(),
           left.row->relative_to_0 && !left.slope ? "; claim `bias(…) == 0`" : "");
  }
}

void check_side(const Claim& claim, const Law& side) {
  if (!claim.left.row->of_a_law || claim.left.slope) {
    refuse(side.where, "`{}` is a law, to which only `distribution(…)` can be equal", side.name);
  }
  if (side.name != "density") check_law(side);
}

/// Checks what needs no estimators: which quantity goes with which relation and side.
void check_claim(const Claim& claim) {
  check_quantity(claim.left);
  if (claim.left.row->of_a_law && claim.relation != Relation::equal) {
    refuse(claim.left.where,
           "laws are equal or not: `distribution(…)` goes with `==`, not with `{}`",
           to_string(claim.relation));
  }
  if (claim.relation == Relation::within && claim.margin.value == 0) {
    refuse(claim.left.where, "a margin of 0 can never be proved; give one above 0");
  }
  std::visit([&](const auto& side) { check_side(claim, side); }, claim.right);
}

/// The shortest decimal whose hundredth, correctly rounded, is `value`.
std::string percent_text(double value) {
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string text =
        fmt::format("{}", std::stod(fmt::format("{:.{}g}", 100 * value, digits)));
    if (parse_margin(text + "%", {}, "").value == value) return text;
  }
  // 100 * value would be rounded: move the point in the text instead.
  const std::string text = fmt::format("{:.16e}", value);
  const std::size_t e = text.find('e');
  return fmt::format("{}e{}", text.substr(0, e), std::stoi(text.substr(e + 1)) + 2);
}

std::string to_string(const Analytic&) { return "analytic"; }

}  // namespace

Claim parse_claim(std::string_view text, const Location& where) {
  Claim claim = Parser(text, where).claim();
  claim.text = boost::trim_copy_if(std::string(text), is_blank);
  check_claim(claim);
  return claim;
}

Source parse_source(std::string_view text, const Location& where) {
  return Parser(text, where).source();
}

std::variant<Source, Constant> parse_reference(std::string_view text, const Location& where) {
  return Parser(text, where).reference();
}

Margin parse_margin(std::string_view text, const Location& where, std::string_view what) {
  try {
    Parser parser(text, where);
    const Margin margin = parser.margin();
    parser.end("the margin");
    return margin;
  } catch (const InputError& e) {
    refuse(where, "{} must be a margin such as `0.5%` or `0.002`, but it is `{}`: {}", what, text,
           e.message());
  }
}

bool is_estimator_name(std::string_view name) {
  try {
    const Source source = parse_source(name, {});
    return source.estimator == name;
  } catch (const InputError&) {
    return false;
  }
}

const char* to_string(Relation relation) {
  constexpr const char* names[] = {"==", "<=", ">=", "<", ">", "within"};
  return names[static_cast<int>(relation)];
}

std::string to_string(const Constant& number) {
  if (number.standard_error == 0) return fmt::format("{}", number.value);
  return fmt::format("{} +- {}", number.value, number.standard_error);
}

std::string to_string(const Law& law) {
  if (law.arguments.empty()) return law.name;
  return fmt::format("{}({})", law.name, fmt::join(law.arguments, ", "));
}

std::string to_string(const Margin& margin) {
  return margin.relative ? percent_text(margin.value) + "%" : fmt::format("{}", margin.value);
}

std::string to_string(const Source& source) {
  return source.part.empty() ? source.estimator : source.estimator + "." + source.part;
}

std::string to_string(const Quantity& quantity) {
  std::string text = fmt::format("{}({}", quantity.row->word, to_string(quantity.source));
  for (const double argument : quantity.arguments) text += fmt::format(", {}", argument);
  return quantity.slope ? fmt::format("slope({}))", text) : text + ")";
}

std::string to_string(const ScaledQuantity& side) {
  const std::string quantity = to_string(side.quantity);
  return side.factor == 1 ? quantity : fmt::format("{} * {}", side.factor, quantity);
}

std::string to_string(const Claim& claim) {
  std::string relation = to_string(claim.relation);
  if (claim.relation == Relation::within) relation += " " + to_string(claim.margin) + " of";
  return fmt::format("{} {} {}", to_string(claim.left), relation,
                     std::visit([](const auto& side) { return to_string(side); }, claim.right));
}

}  // namespace assay::harness
