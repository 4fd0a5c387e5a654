#pragma once

#include <string>

namespace assay::harness {

/// A file that this process alone may replace while the object lives: two runs that add to one
/// ledger take turns. The constructor makes the file, empty, if it is missing. It locks the file
/// itself (flock), and again after another process replaced it. Readers see the old text or the new
/// one, never a part. Throws std::runtime_error with path and reason.
class LockedFile {
 public:
  explicit LockedFile(std::string path);
  ~LockedFile();
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  void replace(const std::string& text) const;

 private:
  std::string path_;
  int descriptor_;
};

}  // namespace assay::harness
