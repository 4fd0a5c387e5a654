#include "harness/suite_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace assay::harness {

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string near = nearest(name, candidates);
  if (!near.empty()) return fmt::format("; did you mean `{}`?", near);
  std::string all;
  for (const std::string& candidate : candidates) all += (all.empty() ? "" : ", ") + candidate;
  return all.empty() ? "; there is none" : "; there is: " + all;
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

const Value& Keys::require(std::string_view key) const {
  if (const Value* value = find(key)) return *value;
  throw InputError(map_.where(), fmt::format("{} needs the key `{}`", what_, key));
}

double positive_number(const Value& value, std::string_view what) {
  const double number = value.number(what);
  if (number > 0 && std::isfinite(number)) return number;
  throw InputError(value.where(),
                   fmt::format("{} must be above 0 and finite, but it is {}", what, value.text()));
}

double error_rate(const Value& value, std::string_view what) {
  const double rate = value.number(what);
  if (rate > 0 && rate <= 0.5) return rate;
  throw InputError(value.where(), fmt::format("{} must be above 0 and at most 0.5, but it is {}",
                                              what, value.text()));
}

std::uint64_t count_from(const Value& value, std::string_view what, std::uint64_t least) {
  const std::uint64_t count = value.count(what);
  if (count >= least) return count;
  throw InputError(value.where(),
                   fmt::format("{} must be at least {}, but it is {}", what, least, value.text()));
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
