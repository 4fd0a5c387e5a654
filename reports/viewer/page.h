#pragma once

// The pictures of a record as the page holds them.

#include <string>
#include <string_view>

#include "reports/record/calibration.h"
#include "reports/record/record.h"

namespace assay::reports {

/// bundle/page.html, compiled in: the viewer with places for title, tables and record.
extern const std::string_view viewer_page;

/// The record and its pictures as bytes: the length of a JSON text in 32 bits, the text, and the
/// planes that the text names. The text holds the record without its maps, in six digits, and a
/// list of pictures. A picture above 2 megapixels is reduced to means of squares of pixels. A small
/// map is kept as 32-bit floats, a larger one as 16-bit codes. A step of z is 1/8. A step of a mean
/// is 1/24 of a factor of two, so that a value is known to 1.5 %.
std::string packed(Record record);

/// The same of a calibration, which has no pictures: its JSON, its verdict and its tables.
std::string packed(const Calibration&);

}  // namespace assay::reports
