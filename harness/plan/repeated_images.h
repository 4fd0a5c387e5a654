#pragma once

// Whether an estimator's images differ from each other.

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Notes a gate for each estimator of images: how many of the pilot's are unlike all others. Amber
/// where some are alike bit for bit. No more: rare events repeat images by right; but so does a
/// renderer that leaves its seed unused, or most of it, and then a fail tells of few pictures.
/// Files that repeat are refused when they are read.
void note_repeated_images(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
