
#include <fmt/format.h>

#include "harness/language/claim.h"

namespace assay::harness {

const char* to_string(Relation relation) {
  constexpr const char* names[] = {"==", "<=", ">=", "<", ">", "within"};
  return names[static_cast<int>(relation)];
}

namespace {

/// The shortest decimal whose hundredth, correctly rounded, is `value`.
std::string percent_text(double value) {
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", 100 * value, digits);
    if (parse_margin(text + "%", {}, "").value == value) return fmt::format("{}", std::stod(text));
  }
  // 100 * value would be rounded: move the point in the text instead.
  const std::string text = fmt::format("{:.16e}", value);
  const std::size_t e = text.find('e');
  return fmt::format("{}e{}", text.substr(0, e), std::stoi(text.substr(e + 1)) + 2);
}

std::string arguments_text(const std::vector<double>& arguments) {
  std::string out;
  for (const double argument : arguments) out += fmt::format(", {}", argument);
  return out;
}

std::string text_of(const ScaledQuantity& side) {
  const std::string quantity = to_string(side.quantity);
  return side.factor == 1 ? quantity : fmt::format("{} * {}", side.factor, quantity);
}

std::string text_of(const Constant& side) {
  if (side.standard_error == 0) return fmt::format("{}", side.value);
  return fmt::format("{} +- {}", side.value, side.standard_error);
}

std::string text_of(const Analytic&) { return "analytic"; }

std::string text_of(const Law& law) {
  if (law.arguments.empty()) return law.name;
  return fmt::format("{}({})", law.name, arguments_text(law.arguments).substr(2));
}

}  // namespace

std::string to_string(const Margin& margin) {
  return margin.relative ? percent_text(margin.value) + "%" : fmt::format("{}", margin.value);
}

std::string to_string(const Law& law) { return text_of(law); }

std::string to_string(const Source& source) {
  return source.part.empty() ? source.estimator : source.estimator + "." + source.part;
}

std::string to_string(const Quantity& quantity) {
  const std::string inner = fmt::format("{}({}{})", quantity.row->word, to_string(quantity.source),
                                        arguments_text(quantity.arguments));
  return quantity.slope ? fmt::format("slope({})", inner) : inner;
}

std::string to_string(const Claim& claim) {
  std::string relation = to_string(claim.relation);
  if (claim.relation == Relation::within) relation += " " + to_string(claim.margin) + " of";
  return fmt::format("{} {} {}", to_string(claim.left), relation,
                     std::visit([](const auto& side) { return text_of(side); }, claim.right));
}

}  // namespace assay::harness
