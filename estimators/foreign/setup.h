#pragma once

// Estimators whose observations are drawn by another program.

#include <memory>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "estimators/foreign/children.h"

namespace assay::foreign {

/// The set-up of what a hello says, whoever answers. An observation is a function of the stream's
/// key and its index: what is answered for them. Nothing is drawn from the stream itself.
std::shared_ptr<const Setup> setup_of(std::shared_ptr<Children> children);

/// Advice on a program that cannot be started: "; the path starts at the suite's folder".
std::string mend_of_program(const std::string& program, std::errc why = {});

/// Starts the program. InputError at the parameter `name`, whose value says which program it is,
/// where it cannot be started or refuses; NoAnswer where it ends, or says what is no hello.
std::shared_ptr<const Setup> start(Terms terms, const Parameters& parameters,
                                   std::string_view name);

/// The limits of any program that is run. `timeout` is in seconds, of what `summary` says.
ParameterInformation timeout_parameter(const std::string& summary, const std::string& fallback);
ParameterInformation memory_parameter();

/// The common parameters of `process` and `library`.
std::vector<ParameterInformation> terms_parameters();
Terms read_terms(Parameters& parameters);

}  // namespace assay::foreign
