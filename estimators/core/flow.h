#pragma once

#include <string_view>

#include "estimators/core/value.h"

namespace assay {

/// A declared fallback as a Value: YAML scalars, lists and maps, as in `[0, 0, 1]` or
/// `{disc: {radius: .3}}`; `null` is null. The text is a plugin author's, not a user's. Throws
/// std::logic_error on anything else.
Value parse_flow(std::string_view text);

}  // namespace assay
