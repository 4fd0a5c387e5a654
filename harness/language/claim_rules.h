#pragma once

#include "harness/language/claim.h"

namespace assay::harness {

/// What a claim must satisfy beyond its grammar and without its estimators: which quantity goes
/// with which relation and side. InputError at the offending part.
void check_claim(const Claim&);

}  // namespace assay::harness
