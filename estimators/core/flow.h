#pragma once

#include <string_view>

#include "estimators/core/value.h"

namespace assay {

/// A declared fallback as a Value: plain scalars, and flow lists and maps of them, as in
/// `[0, 0, 1]` or `{disc: {radius: .3}}`; `null` is null. No quotes, no comments: the text is
/// a plugin author's, not a user's. Throws std::logic_error on anything else.
Value parse_flow(std::string_view text);

}  // namespace assay
