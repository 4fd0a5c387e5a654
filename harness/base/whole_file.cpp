#include "harness/base/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "harness/base/interrupt.h"
#include "harness/base/terminal.h"

namespace assay::harness {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* action, const fs::path& path, int error) {
  throw std::runtime_error(fmt::format("cannot {} {}: {}", action, path.string(),
                                       std::generic_category().message(error)));
}

void write_all(int descriptor, std::string_view text, const fs::path& path) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", path, errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

constexpr std::string_view temporary_begin = ".assay-";
constexpr std::string_view temporary_end = ".tmp";

// False if another process holds the lock. Where there are no locks, nobody does.
bool lock(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

// A temporary file is locked while its process lives. Those of killed processes are removed.
void remove_left_overs(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(temporary_begin) || !name.ends_with(temporary_end)) continue;
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(entry.path().c_str());
    ::close(descriptor);
  }
}

// A name that no other process takes.
fs::path temporary_beside(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  remove_left_overs(folder);
  return folder / fmt::format("{}{}{}", temporary_begin, ::getpid(), temporary_end);
}

// A new file beside the target, locked, and removed unless it takes the target's place.
class Temporary {
 public:
  explicit Temporary(const fs::path& target) : file_(temporary_beside(target)), target_(target) {
    do {
      if (descriptor_ >= 0) ::close(descriptor_);
      ::unlink(file_.c_str());
      descriptor_ = ::open(file_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
      if (descriptor_ < 0) fail("write", target_, errno);
    } while (!is_ours());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (!is_renamed_) ::unlink(file_.c_str());
    ::close(descriptor_);
  }

  void become_target(std::string_view text) {
    write_all(descriptor_, text, target_);
    if (::fsync(descriptor_) != 0) fail("write", target_, errno);
    if (::rename(file_.c_str(), target_.c_str()) != 0) fail("write", target_, errno);
    is_renamed_ = true;
  }

 private:
  // False if another process took the new file for a left-over.
  bool is_ours() const {
    struct stat status {};
    return lock(descriptor_) && ::fstat(descriptor_, &status) == 0 && status.st_nlink > 0;
  }

  fs::path file_;
  fs::path target_;
  int descriptor_ = -1;
  bool is_renamed_ = false;
};

struct Open {
  int descriptor;
  ~Open() { ::close(descriptor); }
};

fs::path behind_links(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_symlink(fs::symlink_status(path, ignored))) return path;
  const fs::path target = fs::weakly_canonical(path, ignored);
  return ignored ? path : target;
}

// ---- Locks

constexpr std::chrono::milliseconds longest_pause(50);
constexpr std::chrono::milliseconds told_after(3000);

int locked(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) fail("lock", path, errno);
  std::chrono::milliseconds waited(0);
  bool told = false;
  while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error == EINTR) continue;
    if (error == EWOULDBLOCK && !interrupted()) {
      if (waited > told_after && !std::exchange(told, true)) {
        say_beside_progress(fmt::format("waiting for another run that writes {}", path));
      }
      const auto pause = std::clamp(waited, std::chrono::milliseconds(1), longest_pause);
      std::this_thread::sleep_for(pause);
      waited += pause;
      continue;
    }
    ::close(descriptor);
    if (interrupted()) {
      throw std::runtime_error(fmt::format("cannot lock {}: the wait was interrupted", path));
    }
    fail("lock", path, error);
  }
  return descriptor;
}

bool is_current(int descriptor, const std::string& path) {
  struct stat open {};
  struct stat named {};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

}  // namespace

void write_whole(const fs::path& path, std::string_view text) {
  const fs::path target = behind_links(path);
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) fail("write", path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    const Open direct{::open(target.c_str(), O_WRONLY | O_CLOEXEC)};
    if (direct.descriptor < 0) fail("write", path, errno);
    write_all(direct.descriptor, text, path);
    return;
  }
  Temporary(target).become_target(text);
}

GrowingFile::GrowingFile(fs::path path)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail("write", path_, errno);
  if (!lock(descriptor_)) {
    ::close(descriptor_);
    throw std::runtime_error(fmt::format("another run is writing to {}", path_.string()));
  }
  size_ = fs::file_size(path_);
}

GrowingFile::~GrowingFile() { ::close(descriptor_); }

void GrowingFile::cut(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail("write", path_, errno);
  size_ = size;
}

void GrowingFile::append(std::string_view bytes) {
  // An earlier call may have failed half-way.
  if (::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET) < 0) fail("write", path_, errno);
  write_all(descriptor_, bytes, path_);
  size_ += bytes.size();
}

void GrowingFile::flush() {
  if (::fsync(descriptor_) != 0) fail("write", path_, errno);
}

std::string GrowingFile::read(std::uint64_t first, std::uint64_t size) const {
  std::string bytes(size, '\0');
  std::uint64_t there = 0;
  while (there < size) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + there, size - there, static_cast<off_t>(first + there));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("read", path_, errno);
    if (got == 0) break;
    there += static_cast<std::uint64_t>(got);
  }
  bytes.resize(there);
  return bytes;
}

LockedFile::LockedFile(const std::string& path) : descriptor_(locked(path)) {
  while (!is_current(descriptor_, path)) {
    ::close(descriptor_);
    descriptor_ = locked(path);
  }
}

LockedFile::~LockedFile() { ::close(descriptor_); }

}  // namespace assay::harness
