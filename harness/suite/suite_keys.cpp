#include "harness/suite/suite_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace assay::harness {

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  return did_you_mean(name, candidates,
                      candidates.empty() ? "there is none" : "there is: " + listed(candidates));
}

Keys::Keys(const Document& document, const Value& map, std::string what,
           const std::vector<std::string>& known)
    : document_(document), map_(map), what_(std::move(what)) {
  if (map.kind() != Value::Kind::map) {
    throw InputError(map.where(), fmt::format("{} must be a map of keys and values", what_));
  }
  for (const auto& [key, value] : map.members()) {
    if (std::ranges::find(known, key) == known.end()) {
      throw InputError(document.key(value),
                       fmt::format("unknown key `{}` of {}{}", key, what_, suggestion(key, known)));
    }
  }
}

const Value& Keys::require(std::string_view key, std::string_view example) const {
  if (const Value* value = find(key)) return *value;
  throw InputError(map_.where(),
                   fmt::format("{} needs the key `{}`, as in `{}`", what_, key, example));
}

namespace {

/// A wrong type and a wrong value get the same message: what is allowed, and what was given.
template <class Read, class Allowed>
auto read_within(const Value& value, std::string_view what, const std::string& range, Read read,
                 Allowed allowed) {
  std::string found = "no single value";
  if (value.kind() == Value::Kind::scalar) {
    found = "`" + value.text() + "`";
    try {
      const auto number = read();
      if (allowed(number)) return number;
    } catch (const InputError&) {
    }
  }
  throw InputError(value.where(), fmt::format("{} must be {}, but it is {}", what, range, found));
}

}  // namespace

double positive_number(const Value& value, std::string_view what) {
  return read_within(
      value, what, "a number above 0", [&] { return value.number(what); },
      [](double number) { return number > 0 && std::isfinite(number); });
}

bool is_error_rate(double rate) { return rate >= 1e-9 && rate <= 0.5; }

double error_rate(const Value& value, std::string_view what) {
  return read_within(
      value, what, "a number from 1e-9 to 0.5 (5 % is 0.05)", [&] { return value.number(what); },
      is_error_rate);
}

std::uint64_t count_from(const Value& value, std::string_view what, std::uint64_t least) {
  return read_within(
      value, what, fmt::format("a whole number, {} or more", least),
      [&] { return value.count(what); }, [&](std::uint64_t count) { return count >= least; });
}

std::string one_line(const Value& value, std::string_view what) {
  const std::string& text = value.string(what);
  const bool blank = text.find_first_not_of(" \t\n") == std::string::npos;
  if (!blank && text.find('\n') == std::string::npos) return text;
  throw InputError(value.where(), fmt::format("{} must be one line of text", what));
}

std::size_t choice(const Value& value, std::string_view what,
                   const std::vector<std::string>& allowed) {
  const std::string& text = value.string(what);
  const auto found = std::ranges::find(allowed, text);
  if (found != allowed.end()) return static_cast<std::size_t>(found - allowed.begin());
  throw InputError(value.where(),
                   fmt::format("{} cannot be `{}`{}", what, text, suggestion(text, allowed)));
}

}  // namespace assay::harness
