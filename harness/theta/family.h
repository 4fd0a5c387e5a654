#pragma once

// How a suite's alpha and beta are shared out, and Holm's decision over the whole suite.

#include <vector>

#include "harness/question/question.h"
#include "harness/theta/decision.h"

namespace assay::harness {

/// A test's place in its suite's family.
struct FamilyPlace {
  bool inside = true;     ///< false: mutants and expected failures
  double weight = 0;      ///< of one channel, the family's weights sum to 1
  ErrorShare share = {};  ///< of one channel: alpha * weight inside, the smallest such outside
};

/// Places of the questions of a suite, in order, from the numbers of channels they claim. Inside
/// the family alpha is split by weight, then evenly over a claim's channels; a test outside has the
/// smallest share in the suite and beta over the number of tests outside. A suite of mutants only
/// shares out alpha among them. A test that no question could be made of keeps its part.
std::vector<FamilyPlace> places(const Suite& suite, const std::vector<Question>& questions);

}  // namespace assay::harness
