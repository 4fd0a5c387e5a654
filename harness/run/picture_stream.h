#pragma once

// Claims on two stacks of pictures that are never held as a whole. Rows are read once; the pilot
// and the test take what they need of them before the next rows.

#include <string>
#include <vector>

#include "harness/base/progress.h"
#include "harness/pilot/pilot.h"
#include "harness/question/question.h"

namespace assay::harness {

/// True if the claim can be answered row by row. It must be its estimators' only one, and ask
/// whether equally many pictures, all of each side, are equal.
bool is_streamed(const Question& question);
/// The claims that can be answered row by row.
std::vector<const Question*> streamed(const std::vector<Question>& questions,
                                      const std::vector<bool>& chosen);

/// Bytes of one side's pictures at a time.
double streamed_bytes(const Subject& side);

struct StreamedPictures {
  /// The pilots with the look at their pictures, or the fault of an unreadable source, or none.
  Pilots pilots = {};
  /// Why there are no pilots: the numbers need whole pictures. "" if the user interrupted.
  std::string fault = {};
};

StreamedPictures stream_pictures(const Question& question, Progress& progress);

}  // namespace assay::harness
