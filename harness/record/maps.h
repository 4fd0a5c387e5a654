#pragma once

// Records image tests: one row for each source, the findings, and maps.

#include <cstddef>
#include <string>
#include <vector>

#include "harness/run/evaluate.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Fills in a source's row: moments over its elements' means, counts over all elements.
void add_elements(const Subject& side, const Summary& summary, reports::Sample& row);

/// Adds findings and maps; nothing if the images could not be tested.
void add_image(const DrawnTest& drawn, reports::Test& test);

/// An image's row in the suite's picture: means over its elements, and of the variances of the
/// `averaged` primaries. The mean has an interval if the pixels are independent.
reports::EstimatorChannel image_channel(const Setup& setup, const Summary& summary, double averaged,
                                        double confidence);

/// Writes every map as an EXR file in the folder `<stem>.maps` beside the JSON report, and names
/// the files in the record. Throws std::runtime_error if one cannot be written.
void write_maps(reports::Record& record, const std::string& json_path);

// Records laws: empirical distribution functions, and the cells of two coordinates as maps.

/// Adds observed and expected counts of each cell and (observed - expected) / sqrt(expected). A
/// sampler is compared with its density, summed over all lobes. Two samples are compared by
/// chi-square-two-sample: the expected count is the first one's part of both together. Its
/// difference is divided by its standard deviation, sqrt(expected m / (n + m)). Adds nothing for
/// other claims, one coordinate, unequal numbers of cells, and tests without numbers.
void add_cells(const DrawnTest& drawn, reports::Test& test);

/// Each side's empirical distribution function with its simultaneous band and the claimed law, at
/// 63 or fewer points equally spaced in rank. The band's error is the channel's share of alpha at
/// the look. Draws without a point are left out. Empty unless the claim compares values of one
/// coordinate.
std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel);

}  // namespace assay::harness
