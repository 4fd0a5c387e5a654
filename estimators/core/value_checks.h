#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/value.h"

namespace assay {

/// A value read as a number of some range. `what` names it in the message ("the lens's radius");
/// InputError at its place where it is none, or lies outside.
double finite_number(const Value& value, const std::string& what);
double at_least_zero(const Value& value, const std::string& what);
double above_zero(const Value& value, const std::string& what);

/// Refuses what is not a map, or a map with a key that is not among `known`.
void require_keys(const Value& value, const std::string& what,
                  const std::vector<std::string>& known);
/// The member of a map; InputError where it is missing.
const Value& required_key(const Value& value, const std::string& what, const char* key);
/// How a message about an unknown name ends: the nearest known one, or all.
std::string alternatives(std::string_view name, const std::vector<std::string>& known);

/// A built-in scene, written as in a suite.
struct NamedScene {
  const char* name;
  const char* text;
};
/// The scene as it is written. A name stands for the text of a built-in one; InputError if there is
/// none.
Value scene_of(const Value& value, std::span<const NamedScene> built_in);

}  // namespace assay
