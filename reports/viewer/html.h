#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record as one page without network or fonts; it can be read without its script. It begins
/// with the answers to statements and the verdicts of all suites. Each suite follows with its
/// estimators, their pairs, and every test with charts, numbers and replay command. The page has a
/// light, a dark and a printed look, and is well-formed XML.
std::string html(const Record&);

}  // namespace assay::reports
