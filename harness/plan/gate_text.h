#pragma once

// Gates in words.

#include <exception>
#include <string>
#include <vector>

#include "harness/plan/outcome.h"

namespace assay::harness {

/// Says what a gate found, with its limit.
std::string gate_sentence(const Gate& gate);
/// One such sentence for each red gate; "" if none is red.
std::string red_gates(const std::vector<Gate>& gates);

/// The message of an error from stats as a sentence, without the leading "function: ".
std::string in_words(const std::exception& error);

/// "rows" or "pictures" of a file.
const char* rows_noun(const Question&);

/// The look's size times `factor`: "1200", or "1200 and 750" if the subjects' sizes differ.
std::string sizes_text(const TestOutcome& outcome, double factor);

/// So many times the observations that are drawn, as a setting that `does` something.
Reason more_drawn(const TestOutcome& outcome, double factor, const std::string& does);

/// Advice that would turn red gates green: more rows, or more primaries and secondaries. For heavy
/// tails it is a claim that needs no moments, or tails that end. Empty if the gates say it
/// themselves. It continues a sentence.
Reason what_would_help(const TestOutcome& outcome);

}  // namespace assay::harness
