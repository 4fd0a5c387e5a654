#pragma once

#include <string>

namespace assay::render {

/// InputError at the file unless OpenEXR's core, which holds every attribute of the headers against
/// the file's size, finds nothing wrong with them. To be asked before a class of the library opens
/// the file: those allocate what an attribute says of its size before they read it, so that 800
/// bytes could ask for 2 GB.
void require_sound_headers(const std::string& file);

}  // namespace assay::render
