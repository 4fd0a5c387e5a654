#pragma once

#include <string_view>

namespace assay::reports {

/// bundle/page.html, compiled in: the viewer with places for title, tables and record.
extern const std::string_view viewer_page;

}  // namespace assay::reports
