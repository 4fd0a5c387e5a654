#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The record as one page that needs nothing else: no network, no fonts, no script to be read.
/// First the answers to the suites' statements, if there are any, and the verdicts of all suites,
/// then for each suite its estimators side by side, where each pair stands, and every test with its
/// pictures, numbers and replay command. Light, dark and print. Well-formed as XML too.
std::string html(const Record&);

}  // namespace assay::reports
