#pragma once

// An image test in the record: one row a source, the findings, and maps.

#include <string>

#include "harness/run/evaluate.h"

namespace assay::harness {

/// One source of an image: moments over all its elements' means; counts over all elements.
reports::Sample image_sample(const TestOutcome& outcome, std::size_t subject, const Drawn& drawn);

/// Fills in what the test found in its images, and the maps; nothing where it could not be tested.
void add_image(const DrawnTest& drawn, reports::Test& test);

struct ImagePicture {
  double averaged = 1;  ///< primaries that an observation averages
  double confidence = 0;
};

/// One row for an image in the suite's picture: means over its elements. The mean has an interval
/// where the pixels are independent.
reports::EstimatorChannel image_channel(const Setup& setup, const Summary& summary,
                                        ImagePicture picture);

/// Gives every map of the record the name of an EXR file in the folder `<stem>.maps` beside the
/// JSON report, and writes these files. Throws std::runtime_error where one cannot be written.
void write_maps(reports::Record& record, const std::string& json_path);

}  // namespace assay::harness
