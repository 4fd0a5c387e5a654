#pragma once

// The method table: the rows of all families.

#include <string>
#include <vector>

#include "harness/theta/method.h"

namespace assay::harness {

/// The table. A new method is a row in the file of its family, and a function for its evidence.
const std::vector<MethodRow>& method_table();

/// The methods that answer a question, the default first; `test:` may force any of them.
std::vector<Method> methods_for(const Question& question);

/// The method of that name. Throws InputError at the test's place if it does not answer the
/// question.
Method find_method(const Question& question, const std::string& name);

/// The null hypothesis in words and symbols.
std::string null_hypothesis(const Question& question, std::size_t channel);

}  // namespace assay::harness
