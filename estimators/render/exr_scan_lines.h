#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace assay::render {

class CoreFile;

/// Where the texels of a part's channels go: that of column x and row y to
/// channels[name][((y - first) * width + x) * apart], rows from the top.
struct ScanLineTexels {
  int part = 0;
  std::map<std::string, float*> channels;
  std::size_t width = 0;  ///< of the whole
  std::size_t height = 0;
  std::size_t first = 0;  ///< row, and the one after the last
  std::size_t last = 0;
  std::size_t apart = 1;
};

/// Reads 32-bit floats of scan lines that are compressed by ZIP or ZIPS, whose checksums show what
/// is damaged, by OpenEXR's core and libdeflate: all channels of a line at once, in less than half
/// the time of its classes. Of halves and of PIZ it is no faster. False where the part is of
/// another kind or size, the rows are not those of whole chunks, or anything is wrong with it: the
/// classes read it then, or say what is wrong.
bool read_scan_lines(const CoreFile& file, const ScanLineTexels& to);

}  // namespace assay::render
