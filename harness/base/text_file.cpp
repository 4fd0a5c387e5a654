#include "harness/base/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "harness/base/refuse.h"
#include "harness/base/terminal.h"
#include "harness/base/work.h"
#include "reports/words/text.h"

namespace assay::harness {

namespace {

constexpr std::size_t largest_file = std::size_t{16} << 20;
constexpr std::size_t shown_bytes = 72;

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80; }

// ---- Files that are written

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* action, const fs::path& path, int error) {
  throw std::runtime_error(fmt::format("cannot {} {}: {}", action, path.string(),
                                       std::generic_category().message(error)));
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

// True if the path still names the open file.
bool is_current(const OpenFile& file, const fs::path& path) {
  struct stat open {};
  struct stat named {};
  return ::fstat(file.descriptor(), &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

// A new file beside the target, locked, and removed unless it takes the target's place.
class Temporary {
 public:
  explicit Temporary(const fs::path& target) : target_(target) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    remove_left_overs(folder);
    file_ = folder / fmt::format("{}{}{}", temporary_begin, ::getpid(), temporary_end);
    do {
      ::unlink(file_.c_str());
      open_.emplace(file_, O_CREAT | O_EXCL | O_WRONLY, target_);
      // Another process may take the new file for a left-over.
    } while (!lock(open_->descriptor()) || !is_current(*open_, file_));
  }
  ~Temporary() {
    if (!is_renamed_) ::unlink(file_.c_str());
  }

  void become_target(std::string_view text) {
    open_->write(text);
    open_->flush();
    if (::rename(file_.c_str(), target_.c_str()) != 0) fail("write", target_, errno);
    is_renamed_ = true;
  }

 private:
  fs::path file_;
  fs::path target_;
  std::optional<OpenFile> open_;
  bool is_renamed_ = false;
};

fs::path behind_links(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_symlink(fs::symlink_status(path, ignored))) return path;
  const fs::path target = fs::weakly_canonical(path, ignored);
  return ignored ? path : target;
}

// ---- Locks

void wait_for_lock(const OpenFile& file) {
  const std::string path = file.path().string();
  for (int tries = 0; ::flock(file.descriptor(), LOCK_EX | LOCK_NB) != 0; ++tries) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) fail("lock", path, errno);
    if (interrupted()) {
      throw std::runtime_error(fmt::format("cannot lock {}: the wait was interrupted", path));
    }
    if (tries == 300) {
      say_beside_progress(fmt::format("waiting for another run that writes {}", path));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace

std::string read_text_file(const std::string& file) {
  const auto fail = [&](const std::string& why) { refuse({}, "cannot read `{}`: {}", file, why); };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) fail("it is a folder; name the files in it");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in && errno == ENOENT) fail("there is no such file" + near_file(file));
  if (!in) fail(errno ? std::strerror(errno) : "it cannot be opened");
  std::string text;
  std::array<char, 65536> chunk{};
  while (text.size() <= largest_file && (in.read(chunk.data(), chunk.size()) || in.gcount() > 0)) {
    text.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) fail("reading it failed");
  if (text.size() > largest_file) fail("it is larger than 16 MiB");
  return text;
}

std::optional<std::string> bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return std::move(bytes).str();
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

void require_utf8(std::string_view text, const std::string& file) {
  for (std::size_t i = 0, next = 0; i < text.size(); i = next) {
    const char32_t read = reports::next_code_point(text, next);
    const bool invalid = read == reports::replacement_character && next == i + 1;
    const unsigned byte = static_cast<unsigned char>(text[i]);
    const bool space = byte == '\t' || byte == '\n' || byte == '\r';
    if (invalid || (byte < 0x20 && !space) || byte == 0x7F) {
      const char* why = invalid ? "is not UTF-8" : "is a control character";
      const std::string_view before = text.substr(0, i);
      const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
      refuse({file, static_cast<int>(std::ranges::count(before, '\n')) + 1,
              static_cast<int>(i - start) + 1},
             "the byte 0x{:02x} {}; save the file as UTF-8 text", byte, why);
    }
  }
}

std::string caret_below(std::string_view line, int column) {
  const std::size_t at = std::min(static_cast<std::size_t>(std::max(column, 1)) - 1, line.size());
  std::size_t begin = at > shown_bytes - 20 ? at - (shown_bytes - 20) : 0;
  while (begin > 0 && begin < at && continues(line[begin])) ++begin;
  std::size_t end = std::min(begin + shown_bytes, line.size());
  while (end > at && end < line.size() && continues(line[end])) --end;
  const std::string head = begin > 0 ? "..." : "";
  // Control characters become one character each, so that the caret stays below its column.
  const std::string before = reports::clean(line.substr(begin, at - begin));
  std::string out = "  " + head + before + reports::clean(line.substr(at, end - at));
  if (end < line.size()) out += "...";
  out += "\n  " + std::string(head.size(), ' ');
  for (const char c : before) {
    if (!continues(c)) out += c == '\t' ? '\t' : ' ';
  }
  return out + "^\n";
}

void write_whole(const fs::path& path, std::string_view text) {
  const fs::path target = behind_links(path);
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) fail("write", path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return OpenFile(target, O_WRONLY, path).write(text);
  }
  Temporary(target).become_target(text);
}

OpenFile::OpenFile(const fs::path& file, int flags, fs::path named)
    : path_(std::move(named)), descriptor_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail("write", path_, errno);
}

OpenFile::~OpenFile() { ::close(descriptor_); }

void OpenFile::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", path_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OpenFile::flush() const {
  if (::fsync(descriptor_) != 0) fail("write", path_, errno);
}

GrowingFile::GrowingFile(const fs::path& path) : file_(path, O_RDWR | O_CREAT, path) {
  if (!lock(file_.descriptor())) {
    throw std::runtime_error(fmt::format("another run is writing to {}", path.string()));
  }
  size_ = fs::file_size(path);
}

void GrowingFile::cut(std::uint64_t size) {
  if (::ftruncate(file_.descriptor(), static_cast<off_t>(size)) != 0) fail("write", path(), errno);
  size_ = size;
}

void GrowingFile::append(std::string_view bytes) {
  // An earlier call may have failed half-way.
  if (::lseek(file_.descriptor(), static_cast<off_t>(size_), SEEK_SET) < 0) {
    fail("write", path(), errno);
  }
  file_.write(bytes);
  size_ += bytes.size();
}

std::string GrowingFile::read(std::uint64_t first, std::uint64_t size) const {
  std::string bytes(size, '\0');
  std::uint64_t there = 0;
  while (there < size) {
    const ssize_t got = ::pread(file_.descriptor(), bytes.data() + there, size - there,
                                static_cast<off_t>(first + there));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("read", path(), errno);
    if (got == 0) break;
    there += static_cast<std::uint64_t>(got);
  }
  bytes.resize(there);
  return bytes;
}

LockedFile::LockedFile(const std::string& path) {
  do {
    file_.emplace(path, O_RDWR | O_CREAT, path);
    wait_for_lock(*file_);
  } while (!is_current(*file_, path));
}

}  // namespace assay::harness
