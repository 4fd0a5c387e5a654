#pragma once

#include <string>
#include <vector>

#include "estimators/estimator.h"

namespace assay::harness {

/// The manual of a plugin: what it estimates, its parameters, what is known exactly of its channels
/// (with default parameters), its samplers, and its mutants among `entries`. Lines of at most 100
/// columns unless a single word is longer.
std::string manual(const Entry& plugin, const std::vector<Entry>& entries);

/// Text broken at blanks into lines of at most `width` columns, `indent` blanks before each. Line
/// ends of the text stay.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);

}  // namespace assay::harness
