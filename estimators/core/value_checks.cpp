#include "estimators/core/value_checks.h"

#include <algorithm>
#include <cmath>

namespace assay {

double finite_number(const Value& value, const std::string& what) {
  const double number = value.number(what);
  value.require(std::isfinite(number), what + " must be finite");
  return number;
}

double at_least_zero(const Value& value, const std::string& what) {
  const double number = finite_number(value, what);
  value.require(number >= 0, what + " must not be negative");
  return number;
}

double above_zero(const Value& value, const std::string& what) {
  const double number = finite_number(value, what);
  value.require(number > 0, what + " must be above 0");
  return number;
}

std::string alternatives(std::string_view name, const std::vector<std::string>& known) {
  return did_you_mean(name, known, "known are " + quoted(known));
}

void require_keys(const Value& value, const std::string& what,
                  const std::vector<std::string>& known) {
  value.require(value.kind() == Value::Kind::map, what + " must be a map");
  for (const auto& [key, member] : value.members()) {
    if (std::ranges::find(known, key) == known.end()) {
      throw InputError(member.where(),
                       what + " has no key `" + key + "`" + alternatives(key, known));
    }
  }
}

const Value& required_key(const Value& value, const std::string& what, const char* key) {
  if (const Value* found = value.find(key)) return *found;
  throw InputError(value.where(), what + " needs the key `" + key + "`");
}

Value scene_of(const Value& value, std::span<const NamedScene> built_in) {
  if (value.kind() != Value::Kind::scalar) return value;
  const std::string& name = value.string("the scene");
  std::vector<std::string> names;
  for (const NamedScene& scene : built_in) {
    if (name == scene.name) return parse_flow(scene.text);
    names.emplace_back(scene.name);
  }
  throw InputError(value.where(), "there is no scene `" + name + "`" + alternatives(name, names));
}

}  // namespace assay
