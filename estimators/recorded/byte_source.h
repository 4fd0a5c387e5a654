#pragma once

// The bytes of a file, a pipe, a device or standard input, each read once and in order.

#include <sys/stat.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace assay::recorded {

/// Tells whether a name stands for standard input: `-`, /dev/stdin, /dev/fd/0, /proc/self/fd/0.
bool is_standard_input(const std::string& file);

/// Returns what messages call a file: its name, or "standard input".
std::string called(const std::string& file);

/// The bytes that a name stands for. What is compressed by gzip comes out unpacked. Nothing is held
/// in memory but what was looked at and not taken. Waits as long as a pipe's writer does.
///
/// InputError at called(file) for a folder, what cannot be opened or read, and damaged or shortened
/// gzip data. The same at the end of a file that was changed meanwhile. std::runtime_error where
/// the wait is interrupted.
class ByteSource {
 public:
  explicit ByteSource(const std::string& file);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  const std::string& name() const { return name_; }
  /// InputError at called(file).
  [[noreturn]] void refuse(const std::string& why) const;
  /// Tells whether the bytes are compressed where they come from.
  bool packed() const { return inflater_ != nullptr; }
  /// The bytes that come next, `least` of them or more; fewer only at the end. Valid until the
  /// next call.
  std::string_view look(std::size_t least = 1);
  /// Leaves the first `count` of them behind.
  void take(std::size_t count) { begin_ += count; }

 private:
  struct Inflater;
  struct Descriptor {
    int number = -1;
    ~Descriptor();
  };

  std::size_t read_some(char* to, std::size_t most) const;
  bool fetch();
  std::size_t fetch_packed();
  bool unpack();
  void require_unchanged() const;

  std::string name_;
  Descriptor descriptor_;
  struct stat opened_ = {};
  std::vector<char> bytes_;  ///< those from begin_ to end_ are next
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool ended_ = false;
  std::unique_ptr<Inflater> inflater_;  ///< where the bytes are compressed
};

}  // namespace assay::recorded
