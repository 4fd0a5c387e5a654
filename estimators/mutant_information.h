#pragma once

#include "estimators/estimator.h"

namespace assay {

/// The static information of a mutant, made whole: from `original` and `defect`, what it does wrong
/// as a verb phrase ("leaves out the cosine."), the summary and the description. The rest is kept.
Information mutant_information(Information mutant);

}  // namespace assay
