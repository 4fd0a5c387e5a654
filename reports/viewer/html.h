#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record as one page without network or fonts. The page is the viewer's bundle and the record
/// with its pictures, packed (pictures.h), compressed and in base64. A reader without scripts sees
/// the Markdown tables. The Content-Security-Policy lets the bundle's own script and style run, no
/// others.
std::string html(const Record&);

}  // namespace assay::reports
