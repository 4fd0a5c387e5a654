#pragma once

// Claims on two stacks of pictures that are never held as a whole. Rows are read once; the pilot
// and the test take what they need of them before the next rows. Other pictures are kept, and must
// fit into memory.

#include <map>
#include <string>
#include <vector>

#include "harness/base/work.h"
#include "harness/pilot/pilot.h"
#include "harness/question/question.h"
#include "harness/sampling/prepare.h"

namespace assay::harness {

/// Claims that can be answered row by row. Each must be its estimators' only one, and ask whether
/// equally many pictures, all of each side, are equal.
using StreamedClaims = std::vector<const Question*>;
StreamedClaims streamed(const std::vector<Question>& questions);

struct StreamedPictures {
  /// The pilots with the look at their pictures, or the fault of an unreadable source, or none.
  Pilots pilots = {};
  /// Why there are no pilots: the numbers need whole pictures. "" if the user interrupted.
  std::string fault = {};
};

StreamedPictures stream_pictures(const Question& question, Progress& progress);

/// Peak bytes of testing the picture files of all these estimators.
double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators,
                     const StreamedClaims& streamed);

/// Bytes that this process may still take, by the system or its control group. Infinity if unknown.
double available_bytes();

/// InputError at the estimator with most pictures if they need more than `available`. The message
/// begins with `fault`, if any: why they cannot be read row by row.
void require_memory(const std::map<std::string, PreparedEstimator>& estimators,
                    const StreamedClaims& streamed, double available,
                    const std::string& fault = "");

}  // namespace assay::harness
