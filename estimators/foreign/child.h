#pragma once

// A program that runs beside this one and is spoken to through its standard input and output.

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace assay::foreign {

/// A program to run: its words, where it runs, the most address space it may take.
struct Launch {
  std::vector<std::string> command;
  std::string folder = "";
  double memory = 0;  ///< MiB; 0: no limit
};

using Deadline = std::chrono::steady_clock::time_point;

/// A read or a write that did not end by its deadline.
class TimeOut : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A running program at the head of a process group of its own. Whatever of the group still runs is
/// killed when this object goes. The end of its standard error is kept. Descriptors of this process
/// are not handed on.
class Child {
 public:
  /// Throws std::system_error when the program cannot be started.
  explicit Child(const Launch& launch);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Writes to its standard input, and tells whether the program still reads. Once it does not,
  /// nothing is written and nothing is thrown: that it ended shows when it is read from.
  bool send(std::string_view bytes, Deadline deadline);
  /// Waits for bytes of its standard output; how many came, 0 when it ended. Throws TimeOut.
  std::size_t receive(std::span<char> into, Deadline deadline);
  /// True if bytes of its standard output can be read now.
  bool has_output();

  /// Asks it to end: its standard input is closed.
  void close_input();
  bool ends_by(Deadline deadline);
  /// Kills the group if it still runs, and waits for the program.
  void kill();

  /// How it ended, in words: "ended with exit status 3". It is killed if it still runs a moment
  /// after its output was closed.
  std::string ending();
  /// The last of what it wrote to standard error before it ended, whole lines where they fit.
  std::string last_errors();
  /// CPU seconds of the program, without those of programs that it started and did not wait for.
  double cpu_seconds() const;

 private:
  bool wait_for(int descriptor, short event, Deadline deadline);
  void keep_errors(std::size_t most);
  bool has_ended();

  pid_t process_ = -1;
  int input_ = -1;
  int output_ = -1;
  int errors_ = -1;
  int status_ = 0;
  bool reaped_ = false;
  bool killed_ = false;
  double seconds_ = 0;
  std::string error_text_;
};

}  // namespace assay::foreign
