#include "recorded/byte_source.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "estimators/core/value.h"
#include "estimators/core/waiting.h"
#include "estimators/ready_made.h"

namespace assay::recorded {

namespace {

constexpr std::size_t portion = std::size_t{1} << 16;

// How long a wait goes on before it asks whether to stop.
constexpr int glance_in_milliseconds = 100;

}  // namespace

bool is_standard_input(const std::string& file) {
  constexpr std::array names{"-", "/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"};
  return std::ranges::find(names, file) != names.end();
}

std::string called(const std::string& file) {
  return is_standard_input(file) ? "standard input" : file;
}

bool is_read_once(const std::string& file) {
  if (is_standard_input(file)) return true;
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status)) {
    return file.starts_with("/dev/fd/") || file.starts_with("/proc/");
  }
  return !std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status);
}

/// gzip data, one member after another.
struct ByteSource::Inflater {
  Inflater() {
    // 15 bits of window, and 16 for the header of gzip.
    if (inflateInit2(&stream, 15 + 16) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream stream = {};
  std::vector<char> packed;
  bool between = false;  ///< a member has ended and no other begun
};

ByteSource::ByteSource(const std::string& file) : name_(called(file)) {
  // Not to be held up where no program has opened a pipe yet: the wait is in read_some().
  descriptor_.number = is_standard_input(file)
                           ? STDIN_FILENO
                           : ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_.number < 0 || ::fstat(descriptor_.number, &opened_) != 0) {
    const std::string why = std::string("it cannot be read: ") + std::strerror(errno);
    if (errno != ENOENT) refuse(why);
    std::error_code ignored;
    const std::string folder = std::filesystem::absolute(file, ignored).parent_path();
    refuse(why + near_file(file, "it was sought in `" + folder + "`"));
  }
  if (S_ISDIR(opened_.st_mode)) refuse("it cannot be read: it is a folder; name a file in it");
  constexpr std::string_view gzip = "\x1f\x8b";
  if (look(gzip.size()).starts_with(gzip)) {
    inflater_ = std::make_unique<Inflater>();
    inflater_->packed.assign(bytes_.data() + begin_, bytes_.data() + end_);
    inflater_->stream.next_in = reinterpret_cast<Bytef*>(inflater_->packed.data());
    inflater_->stream.avail_in = static_cast<uInt>(inflater_->packed.size());
    begin_ = end_ = 0;
  }
}

ByteSource::Descriptor::~Descriptor() {
  if (number > STDIN_FILENO) ::close(number);
}

ByteSource::~ByteSource() = default;

void ByteSource::refuse(const std::string& why) const { throw InputError({.file = name_}, why); }

std::string_view ByteSource::look(std::size_t least) {
  while (!ended_ && end_ - begin_ < least) ended_ = !fetch();
  return {bytes_.data() + begin_, end_ - begin_};
}

/// Waits until there is something to read; files are always ready. Returns how many bytes came at
/// once: 0 at the end.
std::size_t ByteSource::read_some(char* to, std::size_t most) const {
  while (true) {
    stop_if_asked();
    pollfd wanted{.fd = descriptor_.number, .events = POLLIN, .revents = 0};
    const int ready = poll(&wanted, 1, glance_in_milliseconds);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t count = ::read(descriptor_.number, to, most);
    if (count == 0) require_unchanged();
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EINTR || errno == EAGAIN) continue;
    refuse(std::string("it cannot be read: ") + std::strerror(errno));
  }
}

/// Adds bytes to those that are next; false at the end.
bool ByteSource::fetch() {
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
            bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
  end_ -= begin_;
  begin_ = 0;
  bytes_.resize(std::max(bytes_.size(), end_ + portion));
  if (inflater_) return unpack();
  const std::size_t count = read_some(bytes_.data() + end_, bytes_.size() - end_);
  end_ += count;
  return count > 0;
}

/// The number of compressed bytes that are next.
std::size_t ByteSource::fetch_packed() {
  z_stream& stream = inflater_->stream;
  if (stream.avail_in > 0) return stream.avail_in;
  inflater_->packed.resize(portion);
  stream.avail_in = static_cast<uInt>(read_some(inflater_->packed.data(), portion));
  stream.next_in = reinterpret_cast<Bytef*>(inflater_->packed.data());
  return stream.avail_in;
}

bool ByteSource::unpack() {
  z_stream& stream = inflater_->stream;
  stream.next_out = reinterpret_cast<Bytef*>(bytes_.data() + end_);
  stream.avail_out = static_cast<uInt>(std::min(bytes_.size() - end_, portion));
  const Bytef* const before = stream.next_out;
  while (stream.next_out == before) {
    if (fetch_packed() == 0) {
      if (inflater_->between) return false;
      refuse("its gzip data end too early: the file is cut short; copy or write it again");
    }
    if (inflater_->between) {
      // Zero bytes fill up a block behind a member of gzip data.
      for (; stream.avail_in > 0 && *stream.next_in == 0; ++stream.next_in) --stream.avail_in;
      if (stream.avail_in == 0) continue;
      inflateReset(&stream);
    }
    const int code = inflate(&stream, Z_NO_FLUSH);
    inflater_->between = code == Z_STREAM_END;
    if (code != Z_OK && code != Z_STREAM_END) {
      refuse(std::string("its gzip data are damaged") +
             (stream.msg != nullptr ? " (" + std::string(stream.msg) + ")" : "") +
             "; copy or write it again");
    }
  }
  end_ += static_cast<std::size_t>(stream.next_out - before);
  return true;
}

void ByteSource::require_unchanged() const {
  struct stat now {};
  if (!S_ISREG(opened_.st_mode) || ::fstat(descriptor_.number, &now) != 0) return;
  const bool same = now.st_size == opened_.st_size &&
                    now.st_mtim.tv_sec == opened_.st_mtim.tv_sec &&
                    now.st_mtim.tv_nsec == opened_.st_mtim.tv_nsec;
  if (!same) {
    refuse("it was changed while it was read; wait until the program that writes it is done");
  }
}

}  // namespace assay::recorded
