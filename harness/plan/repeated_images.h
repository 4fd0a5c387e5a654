#pragma once

// A gate on images that repeat.

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// Notes for each estimator of images how many of the pilot's are unlike all others: amber if some
/// repeat bit for bit. Rare events may repeat images, but so does a renderer that ignores its seed.
/// Files that repeat are refused when they are read.
void note_repeated_images(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
