#pragma once

// Claims on two stacks of pictures of files, of which no picture is ever there as a whole: they are
// read once, rows after rows, and what the pilot and the test ask of rows is taken before the next.

#include <map>
#include <string>
#include <vector>

#include "harness/base/progress.h"
#include "harness/question/pilot.h"
#include "harness/question/question.h"
#include "harness/theta/family.h"

namespace assay::harness {

/// Whether this claim, the only one of its estimators, is answered from rows: it asks whether as
/// many pictures of either side, and all of them, are equal.
bool is_streamed(const Question& question);
/// Which of the claims are.
std::vector<const Question*> streamed(const std::vector<Question>& questions,
                                      const std::vector<bool>& chosen);

/// Bytes that the pictures of one of its sides take at a time.
double streamed_bytes(const Subject& side);

/// What reading two stacks rows after rows came to.
struct StreamedPictures {
  /// The pilots of the claim's estimators, with the look at their pictures; or the fault of one
  /// that could not be read; or none.
  Pilots pilots = {};
  /// Why there are none: numbers that only pictures kept as a whole can be tested on. "" where the
  /// user interrupted.
  std::string fault = {};
};

StreamedPictures stream_pictures(const Question& question, const FamilyPlace& place,
                                 Progress& progress);

}  // namespace assay::harness
