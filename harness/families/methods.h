#pragma once

// The methods by name: which there are for a question, what null hypothesis each tests, and the
// evidence it draws from data.

#include <span>
#include <string>
#include <vector>

#include "harness/question/question.h"
#include "harness/theta/evidence.h"
#include "harness/theta/method.h"

namespace assay::harness {

/// Whether the method is exact: the normal law says nothing of it.
bool is_exact(const Method& method);

/// The methods that answer a question, the default first; `test:` may force any of them.
std::vector<Method> methods_for(const Question& question);

/// The method of that name. InputError at the test's place when it does not answer the question.
Method find_method(const Question& question, const std::string& name);

/// The null hypothesis in words and symbols.
std::string null_hypothesis(const Method& method, const Question& question, std::size_t channel);

/// The evidence on theta of one channel. `data` is one or two subjects'.
Evidence evidence_of(const Method& method, const Question& question, std::size_t channel,
                     std::span<const ChannelData> data);

}  // namespace assay::harness
