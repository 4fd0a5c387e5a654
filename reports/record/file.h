#pragma once

// Files written whole or not at all.

#include <filesystem>
#include <string_view>

namespace assay::reports {

/// Writes the text to `path`: into a temporary file of the same folder, flushed to disk, then
/// renamed over `path`, so that a reader sees the old file or the new one and never a part.
/// Permissions follow the process's mask. A symbolic link is followed. Something that is not a
/// regular file (a pipe, /dev/stdout, /dev/null) is written to directly, since it must not be
/// replaced. Throws std::runtime_error naming path and reason, and then leaves nothing behind.
void write_whole(const std::filesystem::path& path, std::string_view text);

}  // namespace assay::reports
