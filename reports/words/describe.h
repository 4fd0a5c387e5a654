#pragma once

// A test's numbers in words, the same in every format.

#include <cstdint>
#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// The samples of the worst channel, and those of estimators that have none of its name.
std::vector<const Sample*> worst_samples(const Test&);

/// True unless an assumption of the test's numbers is violated.
bool is_evidence(const Test&);

/// The first number to look for in a test: the worst channel's effect with its named interval.
/// Without an effect it is the p-value that the verdict rests on. Empty if nothing was tested.
std::string key_number(const Test&);

/// "1.05 M rays", or samples where no ray was traced.
std::string cost_text(const Cost&);
/// The same of many draws, with the samples of those that traced none: "64.0 k rays and 40.0 M
/// samples without rays".
std::string cost_text(std::vector<Cost>);
std::uint64_t rays(const Cost&);

/// "suites/triangle.yaml:14".
std::string place(const Test&);

/// Canonical parameters for people, without the quotes that tell text from numbers.
std::string parameters_text(const std::string& canonical);

/// human(), or "none" for a number of data that were never finite.
std::string data_text(const Number& value);

/// The first sentence of the message, or what the verdict says by itself: a report's one line.
std::string headline(const Test&);

/// A label and a sentence.
struct Fact {
  std::string label, text;
  ASSAY_FIELDS(Fact, label, text)
};

/// Everything that a reader of a verdict needs, in reading order: claim, null hypothesis, estimate,
/// p-values, margins, expectation, channels, assumptions, message. Without place and replay
/// command.
std::vector<Fact> facts(const Test&);

/// The same facts as lines "label: sentence", with place and replay command: for formats that show
/// plain text.
std::string plain_text(const Test&);

/// "alpha 0.01 (false alarms), beta 0.01 (misses), seed 1".
std::string levels_text(const Suite& suite);

}  // namespace assay::reports
