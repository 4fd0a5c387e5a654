#pragma once

#include <optional>

namespace assay::reports {

/// A number of the record that may not exist: JSON null.
using Number = std::optional<double>;

}  // namespace assay::reports
