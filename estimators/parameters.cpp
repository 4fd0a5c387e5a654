#include "estimators/parameters.h"

#include <algorithm>
#include <boost/algorithm/string/erase.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "estimators/core/mapped.h"

namespace assay {

namespace {

std::vector<std::string> names_of(const std::vector<ParameterInformation>& declared) {
  return mapped(declared, &ParameterInformation::name);
}

std::string range_text(const ParameterInformation& p) {
  const auto& [low, high, low_excluded, high_excluded] = p.range;
  std::string out;
  if (std::isfinite(low)) {
    out += std::string(low_excluded ? "above " : "at least ") + shortest_text(low);
  }
  if (std::isfinite(high)) {
    out += (out.empty() ? "" : " and ") + std::string(high_excluded ? "below " : "at most ") +
           shortest_text(high);
  }
  if (!out.empty() && !p.unit.empty()) out += " " + p.unit;
  return out.empty() ? "finite" : out;
}

std::vector<std::string> texts_of(const Value& value, const std::string& what) {
  const std::string words = value.text().empty() ? "one two" : value.text();
  value.require(value.kind() == Value::Kind::list,
                what + " must be a list of texts: `[" +
                    boost::replace_all_copy(boost::erase_all_copy(words, ","), " ", ", ") + "]`");
  return mapped(value.items(),
                [&](const Value& item) { return item.string("each item of " + what); });
}

std::string canonical_value(const ParameterInformation& parameter, const Value& value) {
  // A text parameter `1e3` is not the text `1000`; prefixing keeps both from reading as numbers.
  const auto marked = [](const Value& text) { return Value::scalar(":" + text.text()); };
  if (parameter.type == ParameterType::string) return marked(value).canonical();
  if (parameter.type == ParameterType::texts) {
    return Value::list(mapped(value.items(), marked)).canonical();
  }
  return value.canonical();
}

}  // namespace

ParameterInformation number_parameter(std::string name, std::string summary, std::string fallback,
                                      const NumberRange& range, std::string unit) {
  return {.name = std::move(name),
          .summary = std::move(summary),
          .unit = std::move(unit),
          .fallback = std::move(fallback),
          .range = range};
}

ParameterInformation count_parameter(std::string name, std::string summary, std::string fallback,
                                     const NumberRange& range, std::string unit) {
  ParameterInformation count = number_parameter(std::move(name), std::move(summary),
                                                std::move(fallback), range, std::move(unit));
  count.type = ParameterType::count;
  return count;
}

ParameterInformation boolean_parameter(std::string name, std::string summary, bool fallback) {
  return {.name = std::move(name),
          .type = ParameterType::boolean,
          .summary = std::move(summary),
          .fallback = fallback ? "true" : "false"};
}

ParameterInformation text_parameter(std::string name, std::string summary, std::string fallback,
                                    std::vector<std::string> choices) {
  return {.name = std::move(name),
          .type = ParameterType::string,
          .summary = std::move(summary),
          .fallback = std::move(fallback),
          .choices = std::move(choices)};
}

ParameterInformation structure_parameter(std::string name, std::string summary,
                                         std::string fallback, std::string unit) {
  return {.name = std::move(name),
          .type = ParameterType::structure,
          .summary = std::move(summary),
          .unit = std::move(unit),
          .fallback = std::move(fallback)};
}

ParameterInformation beside_draws(ParameterInformation parameter) {
  parameter.shapes_draws = false;
  return parameter;
}

std::vector<ParameterInformation> joined(std::vector<ParameterInformation> all,
                                         const std::vector<ParameterInformation>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Parameters::Parameters(std::string plugin, std::vector<ParameterInformation> declared,
                       const Value& given, std::string folder)
    : plugin_(std::move(plugin)),
      declared_(std::move(declared)),
      where_(given.where()),
      folder_(std::move(folder)) {
  if (given.kind() != Value::Kind::map && given.kind() != Value::Kind::null) {
    throw InputError(where_, plugin_ + ": parameters must be a map of names to values");
  }
  const std::vector<std::string> known = names_of(declared_);
  const std::string all = known.empty() ? "it has none" : "it has: " + listed(known);
  for (const auto& [name, value] : given.members()) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError(value.where(), plugin_ + " has no parameter `" + name + "`" +
                                          did_you_mean(name, known, all));
    }
    values_.emplace(name, value);
    given_.insert(name);
  }
  for (const ParameterInformation& parameter : declared_) {
    if (!this->given(parameter.name)) {
      if (parameter.fallback.empty()) {
        throw InputError(where_, plugin_ + " needs the parameter `" + parameter.name + "` (" +
                                     parameter.summary + ")");
      }
      const bool text = parameter.type == ParameterType::string;
      values_.emplace(parameter.name,
                      text ? Value::scalar(parameter.fallback) : parse_flow(parameter.fallback));
    }
    check(parameter, values_.find(parameter.name)->second);
  }
}

void Parameters::check(const ParameterInformation& parameter, const Value& value) const {
  const std::string what = plugin_ + ": parameter `" + parameter.name + "`";
  switch (parameter.type) {
    case ParameterType::number:
      in_range(parameter, value.number(what));
      break;
    case ParameterType::count:
      in_range(parameter, static_cast<double>(value.count(what)));
      break;
    case ParameterType::boolean:
      value.boolean(what);
      break;
    case ParameterType::string:
      one_of(parameter, value.string(what));
      break;
    case ParameterType::texts:
      texts_of(value, what);
      break;
    case ParameterType::structure:
      break;
  }
}

void Parameters::in_range(const ParameterInformation& parameter, double number) const {
  const NumberRange& range = parameter.range;
  const bool above = range.low_excluded ? number > range.low : number >= range.low;
  const bool below = range.high_excluded ? number < range.high : number <= range.high;
  if (std::isfinite(number) && above && below) return;
  refuse(parameter.name, "must be " + range_text(parameter) + ", but it is " +
                             shortest_text(number) +
                             (parameter.reason.empty() ? "" : ": " + parameter.reason));
}

void Parameters::one_of(const ParameterInformation& parameter, const std::string& text) const {
  const std::vector<std::string>& choices = parameter.choices;
  if (choices.empty() || std::ranges::find(choices, text) != choices.end()) return;
  refuse(parameter.name, "must be one of " + listed(choices) + ", but it is `" + text + "`" +
                             did_you_mean(text, choices));
}

const ParameterInformation& Parameters::declared(std::string_view name) const {
  const auto found = std::ranges::find(declared_, name, &ParameterInformation::name);
  if (found == declared_.end()) {
    throw std::logic_error(plugin_ + " reads the parameter `" + std::string(name) +
                           "`, which it does not declare");
  }
  return *found;
}

const Value& Parameters::value(std::string_view name) {
  read_.insert(declared(name).name);
  return values_.find(name)->second;
}

std::size_t Parameters::place_among_choices(std::string_view name) {
  const std::vector<std::string>& choices = declared(name).choices;
  return static_cast<std::size_t>(std::ranges::find(choices, string(name)) - choices.begin());
}

double Parameters::number(std::string_view name) { return value(name).number(name); }
std::uint64_t Parameters::count(std::string_view name) { return value(name).count(name); }
bool Parameters::boolean(std::string_view name) { return value(name).boolean(name); }
std::string Parameters::string(std::string_view name) { return value(name).string(name); }
std::vector<std::string> Parameters::texts(std::string_view name) {
  return texts_of(value(name), std::string(name));
}
const Value& Parameters::structure(std::string_view name) { return value(name); }

std::string Parameters::file(std::string_view name) {
  const std::filesystem::path path = value(name).string(name);
  if (path.is_absolute() || folder_.empty()) return path.string();
  return (std::filesystem::path(folder_) / path).lexically_normal().string();
}

bool Parameters::given(std::string_view name) const { return given_.contains(name); }

Location Parameters::where(std::string_view name) const {
  return given(name) ? values_.find(name)->second.where() : where_;
}

void Parameters::refuse(std::string_view name, const std::string& why) const {
  throw InputError(where(name), plugin_ + ": parameter `" + std::string(name) + "` " + why);
}

void Parameters::require(bool holds, std::string_view name, const std::string& why) const {
  if (!holds) refuse(name, why);
}

void Parameters::require_all_read() const {
  for (const ParameterInformation& parameter : declared_) {
    if (!read_.contains(parameter.name)) {
      throw std::logic_error(plugin_ + " declares the parameter `" + parameter.name +
                             "` and never reads it: setting it would have no effect");
    }
  }
}

std::string Parameters::canonical() const { return canonical(names_of(declared_)); }

std::string Parameters::canonical(const std::vector<std::string>& names) const {
  std::string out;
  for (const auto& [name, value] : values_) {
    if (std::ranges::find(names, name) == names.end()) continue;
    out += (out.empty() ? "" : ",") + name + "=" + canonical_value(declared(name), value);
  }
  return out;
}

}  // namespace assay
