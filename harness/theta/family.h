#pragma once

// Shares of a suite's alpha and beta.

#include <vector>

#include "harness/question/question.h"
#include "harness/theta/decision.h"

namespace assay::harness {

/// A test's place in its suite's family.
struct FamilyPlace {
  bool inside = true;       ///< False for mutants and expected failures.
  double weight = 0;        ///< Weight of one channel; a family's weights sum to 1.
  ErrorShare share = {};    ///< Share of one channel.
  bool in_seconds = false;  ///< A budget in seconds, the test's or the suite's, bounds it.
};

/// Places of a suite's questions, in order. Inside the family alpha is split by weight, then evenly
/// over a claim's channels. A test outside has the smallest share in the suite, and beta over the
/// number of tests outside. A suite of mutants only shares out alpha among them. A test without a
/// question keeps its part.
std::vector<FamilyPlace> places(const Suite& suite, const std::vector<Question>& questions);

}  // namespace assay::harness
