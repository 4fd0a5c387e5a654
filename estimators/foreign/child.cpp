#include "estimators/foreign/child.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "estimators/core/waiting.h"

namespace assay::foreign {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// How often a wait looks whether the program is still there and whether waiting is to end.
constexpr milliseconds glance{100};
// A program that closed its output may take so long to end before it is killed.
constexpr milliseconds grace{1000};
constexpr std::size_t kept_errors = 4096;
// A flood must not keep the caller: so much is read before it looks at the rest of the world.
constexpr std::size_t some_errors = std::size_t{1} << 18;
constexpr int wanted_pipe = 1 << 20;

[[noreturn]] void system_failure(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

void check(int error) {
  if (error != 0) system_failure(error, "posix_spawn");
}

void close_descriptor(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

/// Both ends of a pipe, closed unless taken; no other program inherits them.
struct Pipe {
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) system_failure(errno, "pipe");
    // Fewer changes between the two programs; where the system allows less it is only slower.
    fcntl(ends[1], F_SETPIPE_SZ, wanted_pipe);
  }
  ~Pipe() {
    for (int& end : ends) close_descriptor(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int take(std::size_t end) {
    fcntl(ends[end], F_SETFL, fcntl(ends[end], F_GETFL) | O_NONBLOCK);
    return std::exchange(ends[end], -1);
  }

  std::array<int, 2> ends{-1, -1};  ///< reading, writing
};

/// What posix_spawn() is told of files and signals.
struct Spawning {
  Spawning() {
    check(posix_spawn_file_actions_init(&files));
    check(posix_spawnattr_init(&process));
  }
  ~Spawning() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&process);
  }
  Spawning(const Spawning&) = delete;
  Spawning& operator=(const Spawning&) = delete;
  posix_spawn_file_actions_t files{};
  posix_spawnattr_t process{};
};

/// Null-terminated pointers to texts, as a program is given its arguments.
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// This process's, with the folder that the program runs in as PWD: some programs, Blender among
/// them, do not ask the system for it.
std::vector<std::string> environment_of(const Launch& launch) {
  std::vector<std::string> all;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (launch.folder.empty() || !std::string_view(*variable).starts_with("PWD=")) {
      all.emplace_back(*variable);
    }
  }
  std::error_code error;
  const auto folder = std::filesystem::canonical(launch.folder, error);
  if (!error) all.push_back("PWD=" + folder.string());
  return all;
}

pid_t spawn(const Launch& launch, const std::array<int, 3>& standard) {
  Spawning spawning;
  for (int i = 0; i < 3; ++i) {
    check(posix_spawn_file_actions_adddup2(&spawning.files, standard[static_cast<std::size_t>(i)],
                                           i));
  }
  check(posix_spawn_file_actions_addclosefrom_np(&spawning.files, 3));
  if (!launch.folder.empty()) {
    check(posix_spawn_file_actions_addchdir_np(&spawning.files, launch.folder.c_str()));
  }
  // A group of its own, signals as a shell leaves them.
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : {SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGCHLD, SIGHUP, SIGXFSZ}) {
    sigaddset(&defaults, signal);
  }
  sigset_t none;
  sigemptyset(&none);
  check(posix_spawnattr_setsigdefault(&spawning.process, &defaults));
  check(posix_spawnattr_setsigmask(&spawning.process, &none));
  check(posix_spawnattr_setpgroup(&spawning.process, 0));
  check(posix_spawnattr_setflags(
      &spawning.process,
      static_cast<short>(POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK)));
  std::vector<std::string> words = launch.command;
  const std::vector<char*> arguments = pointers_to(words);
  std::vector<std::string> variables = environment_of(launch);
  pid_t child = -1;
  check(posix_spawnp(&child, arguments[0], &spawning.files, &spawning.process, arguments.data(),
                     pointers_to(variables).data()));
  return child;
}

void limit(pid_t process, const Launch& launch) {
  // A crash is reported; its core would be left lying about.
  const rlimit none{0, 0};
  prlimit(process, RLIMIT_CORE, &none, nullptr);
  if (launch.memory <= 0) return;
  const auto bytes = static_cast<rlim_t>(launch.memory * 1048576);
  const rlimit most{bytes, bytes};
  if (prlimit(process, RLIMIT_AS, &most, nullptr) != 0 && errno != ESRCH) {
    system_failure(errno, "prlimit");
  }
}

/// Writes without being ended by SIGPIPE, whatever the process does with that signal elsewhere.
ssize_t write_quietly(int descriptor, std::string_view bytes) {
  sigset_t broken;
  sigset_t before;
  sigset_t pending;
  sigemptyset(&broken);
  sigaddset(&broken, SIGPIPE);
  sigpending(&pending);
  const bool was_pending = sigismember(&pending, SIGPIPE) == 1;
  pthread_sigmask(SIG_BLOCK, &broken, &before);
  const ssize_t written = write(descriptor, bytes.data(), bytes.size());
  const int error = errno;
  if (written < 0 && error == EPIPE && !was_pending) {
    const timespec now{};
    while (sigtimedwait(&broken, nullptr, &now) < 0 && errno == EINTR) {
    }
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return written;
}

bool would_block(int error) { return error == EAGAIN || error == EINTR; }

}  // namespace

Child::Child(const Launch& launch) {
  Pipe input;
  Pipe output;
  Pipe errors;
  process_ = spawn(launch, {input.ends[0], output.ends[1], errors.ends[1]});
  input_ = input.take(1);
  output_ = output.take(0);
  errors_ = errors.take(0);
  try {
    limit(process_, launch);
  } catch (...) {
    kill();
    throw;
  }
}

Child::~Child() {
  kill();
  for (int* descriptor : {&input_, &output_, &errors_}) close_descriptor(*descriptor);
}

bool Child::wait_for(int descriptor, short event, Deadline deadline) {
  while (true) {
    stop_if_asked();
    std::array<pollfd, 2> watched = {{{descriptor, event, 0}, {errors_, POLLIN, 0}}};
    const auto left = std::chrono::ceil<milliseconds>(deadline - steady_clock::now());
    const auto wait = std::clamp(left, milliseconds{0}, glance).count();
    poll(watched.data(), errors_ >= 0 ? 2 : 1, static_cast<int>(wait));
    if (errors_ >= 0 && watched[1].revents != 0) keep_errors(some_errors);
    if (watched[0].revents != 0) return true;
    // A program that it started may hold the pipe open after it has gone.
    if (has_ended()) return false;
    if (steady_clock::now() >= deadline) throw TimeOut("time-out");
  }
}

bool Child::send(std::string_view bytes, Deadline deadline) {
  while (!bytes.empty() && input_ >= 0) {
    const ssize_t written = write_quietly(input_, bytes);
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (!would_block(errno)) {
      close_descriptor(input_);
    } else if (!wait_for(input_, POLLOUT, deadline)) {
      return false;
    }
  }
  return input_ >= 0;
}

std::size_t Child::receive(std::span<char> into, Deadline deadline) {
  while (true) {
    const ssize_t count = read(output_, into.data(), into.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (!would_block(errno)) return 0;
    if (wait_for(output_, POLLIN, deadline)) continue;
    // It ended: what it wrote before is still in the pipe.
    const ssize_t rest = read(output_, into.data(), into.size());
    return rest > 0 ? static_cast<std::size_t>(rest) : 0;
  }
}

bool Child::has_output() {
  pollfd watched{output_, POLLIN, 0};
  return poll(&watched, 1, 0) == 1 && (watched.revents & POLLIN) != 0;
}

void Child::keep_errors(std::size_t most) {
  std::array<char, 4096> buffer{};
  for (std::size_t done = 0; done < most;) {
    const ssize_t count = read(errors_, buffer.data(), buffer.size());
    if (count == 0 || (count < 0 && !would_block(errno))) return close_descriptor(errors_);
    if (count < 0) return;
    done += static_cast<std::size_t>(count);
    error_text_.append(buffer.data(), static_cast<std::size_t>(count));
    if (error_text_.size() > 2 * kept_errors) {
      error_text_.erase(0, error_text_.size() - kept_errors);
    }
  }
}

void Child::close_input() { close_descriptor(input_); }

bool Child::has_ended() {
  if (reaped_) return true;
  siginfo_t information{};
  const int found =
      waitid(P_PID, static_cast<id_t>(process_), &information, WEXITED | WNOHANG | WNOWAIT);
  return found == 0 && information.si_pid == process_;
}

bool Child::ends_by(Deadline deadline) {
  while (!has_ended()) {
    if (steady_clock::now() >= deadline) return false;
    if (errors_ >= 0) keep_errors(some_errors);
    std::this_thread::sleep_for(milliseconds{2});
  }
  return true;
}

void Child::kill() {
  if (reaped_ || process_ <= 0) return;
  killed_ = !has_ended();
  // Before it is reaped: until then nobody else can have the number of its group.
  ::kill(-process_, SIGKILL);
  rusage used{};
  while (wait4(process_, &status_, 0, &used) < 0 && errno == EINTR) {
  }
  reaped_ = true;
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  seconds_ = std::max(seconds_, seconds(used.ru_utime) + seconds(used.ru_stime));
}

std::string Child::ending() {
  if (!reaped_) {
    ends_by(steady_clock::now() + grace);
    kill();
  }
  if (killed_) return "closed its standard output";
  if (WIFSIGNALED(status_)) {
    const int signal = WTERMSIG(status_);
    return "was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  }
  return "ended with exit status " + std::to_string(WEXITSTATUS(status_));
}

std::string Child::last_errors() {
  // It ended: what it wrote before is in the pipe, which holds no more than this.
  if (errors_ >= 0) keep_errors(static_cast<std::size_t>(fcntl(errors_, F_GETPIPE_SZ)));
  std::string text = error_text_;
  if (text.size() > kept_errors) text.erase(0, text.size() - kept_errors);
  return text;
}

double Child::cpu_seconds() const {
  clockid_t clock{};
  timespec time{};
  if (reaped_ || clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &time) != 0) {
    return seconds_;
  }
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace assay::foreign
