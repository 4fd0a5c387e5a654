#pragma once

// A running program and the conversation with it.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimators/foreign/child.h"
#include "estimators/foreign/hello.h"
#include "estimators/foreign/reply.h"

namespace assay::foreign {

/// How to run a program and how long to wait for a reply.
struct Terms {
  Launch launch;
  double timeout = 60;  ///< seconds a reply may take
  std::string name;     ///< of the program in messages
};

/// Why a program did not answer: a sentence with the program's name, how it ended and the end of
/// its standard error.
class NoAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Dialogue {
 public:
  /// Starts the program and reads its hello. Throws NoAnswer.
  explicit Dialogue(const Terms& terms);

  const Hello& hello() const { return hello_; }
  /// The numbers of the observations, one after the other. Throws NoAnswer, after which the program
  /// no longer runs.
  std::vector<double> ask(const Question& question);
  /// The same of a question to a sampler, whose items follow it.
  std::vector<double> ask(const Question& question, std::string_view items);
  /// How many of the question's observations or items to ask for at a time, by how long the last
  /// replies to such questions took.
  std::uint64_t well_sized(const Question& question) const;
  /// Whether nothing of this kind, of the same sampler, has been asked yet.
  bool is_new_to(const Question& question) const;
  /// Whether it was shown that the program draws an observation the same when asked again.
  bool witnessed() const { return witnessed_; }
  void note_witnessed() { witnessed_ = true; }
  double cpu_seconds() const { return child_.cpu_seconds(); }
  Child& child() { return child_; }

 private:
  Deadline deadline() const;
  void hear_hello();
  std::vector<double> hear(const Question& question, std::string_view items);
  void learn_pace(const Question& question, double seconds);
  [[noreturn]] void give_up(const std::string& why);

  const Terms& terms_;
  Child child_;
  Hello hello_;
  /// Of questions for observations, and to each sampler for each of what it is asked.
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint64_t> sizes_;
  bool witnessed_ = false;
};

}  // namespace assay::foreign
