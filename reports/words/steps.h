#pragma once

// Steps to take about a claim that is not as it should be.

#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// The trouble with a claim, without a p-value where it can be said so.
std::string trouble(const Test&);

/// Something to do, and a line to paste for it.
struct Step {
  std::string label;  ///< "again", "add to the test"
  std::string paste;
};
/// The most useful first. A message that ends in "write `TEXT`" gives the text to paste. Empty if
/// the words of trouble() are all there is to say.
std::vector<Step> steps(const Test&);

/// The command that tells more of a test.
Step explanation(const Test&);

}  // namespace assay::reports
