#pragma once

// Files written whole or not at all, by one process at a time.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace assay::harness {

/// Writes the text to `path`, whole or not at all. A temporary file in the same folder is flushed
/// to disk and renamed over `path`. Those that killed processes left there are removed. Permissions
/// follow the process's mask. A symbolic link is followed. Something other than a regular file (a
/// pipe, /dev/stdout) is written to directly, because it must not be replaced. Throws
/// std::runtime_error that names path and reason, and leaves nothing behind.
void write_whole(const std::filesystem::path& path, std::string_view text);

/// Writes the text to the place `first` of a file, which ends with it. Makes the file if it is
/// missing. Throws std::runtime_error that names path and reason.
void write_end(const std::filesystem::path& path, std::uint64_t first, std::string_view text);
/// Waits until a file is on the disk. Throws the same.
void flush(const std::filesystem::path& path);

/// A file that this process alone may replace while the object lives: two runs that add to one
/// ledger take turns. The constructor makes the file, empty, if it is missing. It locks the file
/// itself (flock), and again after another process replaced it. Readers see the old text or the new
/// one, never a part. Throws std::runtime_error with path and reason.
class LockedFile {
 public:
  explicit LockedFile(const std::string& path);
  ~LockedFile();
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

 private:
  int descriptor_;
};

}  // namespace assay::harness
