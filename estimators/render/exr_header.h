#pragma once

#include <memory>
#include <string>

namespace assay::render {

/// A file that OpenEXR's core has open (render/core_file.h).
class CoreFile;

/// InputError at the file unless OpenEXR's core, which holds every attribute of the headers against
/// the file's size, finds nothing wrong with them. To be asked before a class of the library opens
/// the file: those allocate what an attribute says of its size before they read it, so that 800
/// bytes could ask for 2 GB.
std::shared_ptr<CoreFile> open_sound_file(const std::string& file);

}  // namespace assay::render
