#include "estimators/library_host.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <boost/algorithm/string/replace.hpp>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "estimators/core/flush_denormals.h"
#include "estimators/core/quoting.h"
#include "estimators/foreign/protocol.h"
#include "estimators/foreign/shared_library.h"

namespace assay {

namespace {

using foreign::PreparedLibrary;
using foreign::Question;

constexpr int failed = 3;

std::string host_program;

/// The pipes of the protocol, out of the library's reach. The library reads an empty standard
/// input; its standard output goes to a file in memory.
class Channels {
 public:
  Channels()
      : questions_(fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3)),
        replies_(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)),
        printed_(memfd_create("printed", MFD_CLOEXEC)) {
    const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (questions_ < 0 || replies_ < 0 || printed_ < 0 || nothing < 0 ||
        dup2(nothing, STDIN_FILENO) < 0 || dup2(printed_, STDOUT_FILENO) < 0) {
      throw std::system_error(errno, std::generic_category(), "standard input and output");
    }
    close(nothing);
  }

  int questions() const { return questions_; }

  bool read_question(Question& question) const {
    static_assert(sizeof question == 32);
    return fill({reinterpret_cast<char*>(&question), sizeof question});
  }

  /// The items that follow a question to a sampler.
  std::string read_items(const Question& question) const {
    if (!question.is_to_sampler()) return "";
    std::string items(8 * foreign::item_words(question.asked()) * question.count, '\0');
    if (!fill(items)) throw std::runtime_error("the question ended early");
    return items;
  }

  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(replies_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) throw std::system_error(errno, std::generic_category(), "a reply");
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  /// The beginning of the library's standard output.
  std::string printed() const {
    std::fflush(stdout);
    std::array<char, 128> text{};
    const ssize_t count = pread(printed_, text.data(), text.size(), 0);
    return {text.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
  }

 private:
  bool fill(std::span<char> bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = read(questions_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
  }

  int questions_;
  int replies_;
  int printed_;
};

void refuse_printing(const Channels& channels) {
  const std::string printed = channels.printed();
  if (printed.empty()) return;
  throw foreign::LibraryError(
      "the library printed `" + shown(printed) +
      "` to standard output, which is not its own; print to standard error");
}

/// Ends this process when the one that asks has gone, even if the library never returns.
void watch(int questions) {
  std::thread([questions] {
    pollfd watched{questions, 0, 0};
    while (poll(&watched, 1, -1) < 1) {
    }
    std::this_thread::sleep_for(std::chrono::seconds{1});
    _exit(failed);
  }).detach();
}

void serve(const PreparedLibrary& library, const Channels& channels) {
  channels.write(to_text(library.hello()));
  for (Question question; channels.read_question(question);) {
    const std::vector<double> numbers = library.answer(question, channels.read_items(question));
    refuse_printing(channels);
    channels.write(
        {reinterpret_cast<const char*>(numbers.data()), sizeof(double) * numbers.size()});
    channels.write(to_bytes(question, foreign::Numbers::binary));
  }
}

std::unique_ptr<const PreparedLibrary> prepared(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3 || arguments.size() % 2 == 0) {
    throw std::runtime_error("a host is given file, estimator, folder, then names and values");
  }
  foreign::LibraryChoice choice{
      .file = arguments[0], .estimator = arguments[1], .folder = arguments[2]};
  for (std::size_t i = 3; i < arguments.size(); i += 2) {
    choice.parameters.emplace_back(arguments[i], arguments[i + 1]);
  }
  const FlushDenormals flush;
  return std::make_unique<const PreparedLibrary>(choice);
}

}  // namespace

void set_library_host(const std::string& program) { host_program = program; }

std::string library_host() {
  if (!host_program.empty()) return host_program;
  const char* const program = std::getenv("ASSAY_PROGRAM");
  if (program != nullptr && *program != '\0') return program;
  throw std::runtime_error(
      "needs the program `assay` to run in; name it by the environment variable ASSAY_PROGRAM, or "
      "set `isolated: false`");
}

int host_library(const std::vector<std::string>& arguments) {
  const Channels channels;
  watch(channels.questions());
  std::unique_ptr<const PreparedLibrary> library;
  try {
    library = prepared(arguments);
    refuse_printing(channels);
  } catch (const std::exception& error) {
    channels.write("assay 1 binary\nerror " +
                   boost::replace_all_copy(std::string(error.what()), "\n", " ") + "\n");
    return failed;
  }
  try {
    serve(*library, channels);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return failed;
  }
  return 0;
}

}  // namespace assay
