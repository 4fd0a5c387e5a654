#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace assay::render {

class CoreFile;

/// The place of a part's texels. Column x and row y go to channels[name][((y - first) * width + x)
/// * apart], rows from the top.
struct ScanLineTexels {
  int part = 0;
  std::map<std::string, float*> channels;
  std::size_t width = 0;  ///< of the whole
  std::size_t height = 0;
  std::size_t first = 0;  ///< row, and the one after the last
  std::size_t last = 0;
  std::size_t apart = 1;
};

/// Reads 32-bit floats of scan lines that ZIP or ZIPS compresses, by OpenEXR's core and libdeflate.
/// Checksums show damage. All channels of a line come at once, in less than half the time of
/// OpenEXR's classes. Returns false for a part of another kind or size, for rows that are not whole
/// chunks, and for any fault. The classes then read it, or report the fault.
bool read_scan_lines(const CoreFile& file, const ScanLineTexels& to);

}  // namespace assay::render
