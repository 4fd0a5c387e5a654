#pragma once

#include "harness/language/claim.h"

namespace assay::harness {

/// Checks what needs no estimators: which quantity goes with which relation and side. InputError at
/// the offending part.
void check_claim(const Claim&);

}  // namespace assay::harness
