#pragma once

#include <memory>
#include <string>

namespace assay::render {

/// A file that OpenEXR's core has open (render/core_file.h).
class CoreFile;

/// InputError at the file if OpenEXR's core finds a fault in the headers. The core holds every
/// attribute against the file's size. Call it before a class of the library opens the file: such a
/// class allocates the size that an attribute states before it reads it.
std::shared_ptr<CoreFile> open_sound_file(const std::string& file);

}  // namespace assay::render
