#pragma once

#include "estimators/estimator.h"

namespace assay {

/// Completes the static information of a mutant. `original` and `defect` give the summary and the
/// description. `defect` is a verb phrase ("leaves out the cosine."). The rest is kept.
Information mutant_information(Information mutant);

}  // namespace assay
