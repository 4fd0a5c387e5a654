#pragma once

// Records image tests: one row for each source, the findings, and maps.

#include <string>

#include "harness/run/evaluate.h"

namespace assay::harness {

/// Fills in a source's row: moments over its elements' means, counts over all elements.
void add_elements(const Subject& side, const Summary& summary, reports::Sample& row);

/// Adds findings and maps; nothing if the images could not be tested.
void add_image(const DrawnTest& drawn, reports::Test& test);

struct ImagePicture {
  double averaged = 1;  ///< primaries that an observation averages
  double confidence = 0;
};

/// An image's row in the suite's picture: means over its elements. The mean has an interval if the
/// pixels are independent.
reports::EstimatorChannel image_channel(const Setup& setup, const Summary& summary,
                                        ImagePicture picture);

/// Writes every map as an EXR file in the folder `<stem>.maps` beside the JSON report, and names
/// the files in the record. Throws std::runtime_error if one cannot be written.
void write_maps(reports::Record& record, const std::string& json_path);

}  // namespace assay::harness
