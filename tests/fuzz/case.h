#pragma once

// The common part of fuzz targets: their headers, a promise that ends the program if it is broken,
// and a case as a text and as a file.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace assay::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Writes a case to a file of this process alone, in memory where the system has such a place, and
/// names it. `ending` as ".yaml".
inline std::string written(const std::uint8_t* data, std::size_t size, const std::string& ending) {
  static const std::string file =
      std::string(std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp") +
      "/assay_fuzz_" + std::to_string(getpid()) + ending;
  std::ofstream(file, std::ios::binary) << text_of(data, size);
  return file;
}

}  // namespace assay::fuzz
