#pragma once

#include <string>
#include <vector>

#include "estimators/estimator.h"

namespace assay::harness {

/// The manual of a plugin: what it estimates, its parameters, samplers, and mutants among
/// `entries`. Known values of its channels are those for default parameters. Lines have at most 100
/// columns, unless a word is longer.
std::string manual(const Entry& plugin, const std::vector<Entry>& entries);

/// The text in lines of at most `width` columns, each after `indent` blanks. Its line ends stay.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);

}  // namespace assay::harness
