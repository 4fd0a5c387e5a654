#include "harness/base/locked_file.h"

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
#include "harness/base/whole_file.h"

namespace assay::harness {
namespace {

constexpr std::chrono::milliseconds longest_pause(50);
constexpr std::chrono::milliseconds told_after(3000);

[[noreturn]] void fail(const std::string& path, int error) {
  throw std::runtime_error(
      fmt::format("cannot lock {}: {}", path, std::generic_category().message(error)));
}

int locked(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(path, errno);
  std::chrono::milliseconds waited(0);
  bool told = false;
  while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error == EINTR) continue;
    if (error == EWOULDBLOCK && !interrupted()) {
      if (waited > told_after && !std::exchange(told, true)) {
        say_beside_progress(fmt::format("waiting for {}, to which another run is adding", path));
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
    fail(path, error);
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

LockedFile::LockedFile(std::string path) : path_(std::move(path)), descriptor_(locked(path_)) {
  while (!is_current(descriptor_, path_)) {
    ::close(descriptor_);
    descriptor_ = locked(path_);
  }
}

LockedFile::~LockedFile() { ::close(descriptor_); }

void LockedFile::replace(const std::string& text) const { write_whole(path_, text); }

}  // namespace assay::harness
