#pragma once

// Files written whole or not at all.

#include <filesystem>
#include <string_view>

namespace assay::harness {

/// Writes the text to `path`, whole or not at all. A temporary file in the same folder is flushed
/// to disk and renamed over `path`. Those that killed processes left there are removed. Permissions
/// follow the process's mask. A symbolic link is followed. Something other than a regular file (a
/// pipe, /dev/stdout) is written to directly, because it must not be replaced. Throws
/// std::runtime_error that names path and reason, and leaves nothing behind.
void write_whole(const std::filesystem::path& path, std::string_view text);

}  // namespace assay::harness
