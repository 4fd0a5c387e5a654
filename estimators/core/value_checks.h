#pragma once

#include <string>

#include "estimators/core/value.h"

namespace assay {

/// A value read as a number of some range. `what` names it in the message ("the lens's radius");
/// InputError at its place where it is none, or lies outside.
double finite_number(const Value& value, const std::string& what);
double at_least_zero(const Value& value, const std::string& what);
double above_zero(const Value& value, const std::string& what);

}  // namespace assay
