#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/value.h"

namespace assay::harness {

/// The whole of a text file. InputError when it is missing, a folder, unreadable or over 16 MiB.
std::string read_text_file(const std::string& file);

/// The bytes of any file, if it can be read.
std::optional<std::string> bytes_of(const std::string& file);

std::vector<std::string_view> lines_of(std::string_view text);

/// Throws InputError at the first byte that is not UTF-8 or is a control character other than tab
/// and line end.
void require_utf8(std::string_view text, const std::string& file);

/// The line, and under it a caret below the column (bytes, from 1). A long line is cut to the
/// neighbourhood of the column; control characters are replaced (reports::clean).
std::string caret_below(std::string_view line, int column);

// ---- Files written whole or not at all, by one process at a time.

/// Writes the text to `path`, whole or not at all. A temporary file in the same folder is flushed
/// to disk and renamed over `path`. Those that killed processes left there are removed. Permissions
/// follow the process's mask. A symbolic link is followed. Something other than a regular file (a
/// pipe, /dev/stdout) is written to directly, because it must not be replaced. Throws
/// std::runtime_error that names path and reason, and leaves nothing behind.
void write_whole(const std::filesystem::path& path, std::string_view text);

/// A file that is open to be written, by open(2) with these flags. Each function throws
/// std::runtime_error with the reason and the path that messages name.
class OpenFile {
 public:
  OpenFile(const std::filesystem::path& file, int flags, std::filesystem::path named);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }
  void write(std::string_view bytes) const;
  /// Waits until all is on the disk.
  void flush() const;

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// A file to which this process adds while the object lives. Made empty if it is missing. Each
/// function throws std::runtime_error with path and reason; the constructor also if another process
/// has the file.
class GrowingFile {
 public:
  explicit GrowingFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t size() const { return size_; }
  /// Drops what follows the first `size` bytes.
  void cut(std::uint64_t size);
  void append(std::string_view bytes);
  void flush() const { file_.flush(); }
  /// Fewer bytes if the file ends.
  std::string read(std::uint64_t first, std::uint64_t size) const;

 private:
  OpenFile file_;
  std::uint64_t size_;
};

/// A file that this process alone may replace while the object lives: two runs that add to one
/// ledger take turns. The constructor makes the file, empty, if it is missing. It locks the file
/// itself (flock), and again after another process replaced it. Readers see the old text or the new
/// one, never a part. Throws std::runtime_error with path and reason.
class LockedFile {
 public:
  explicit LockedFile(const std::string& path);

 private:
  std::optional<OpenFile> file_;
};

}  // namespace assay::harness
