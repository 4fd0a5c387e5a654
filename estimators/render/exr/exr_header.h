#pragma once

#include <string>

namespace assay::render {

/// InputError at the file if OpenEXR's core finds a fault in the headers. The core holds every
/// attribute against the file's size. Call it before a class of the library opens the file: such a
/// class allocates the size that an attribute states before it reads it.
void require_sound_headers(const std::string& file);

}  // namespace assay::render
