#pragma once

// A running program and the conversation with it.

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimators/foreign/child.h"
#include "estimators/foreign/protocol.h"

namespace assay::foreign {

/// How to run a program and how long to wait for a reply.
struct Terms {
  Launch launch;
  double timeout = 60;  ///< Seconds that a reply may take.
  std::string name;     ///< Name of the program in messages.
  /// Set once a program of the set-up that said nothing for 3 s was asked if it flushes its output.
  /// Null if output cannot wait in a buffer.
  std::shared_ptr<std::atomic_flag> asked_whether_it_flushes = {};
  /// Who prints the line `ready`, and when.
  std::string who_is_ready =
      "a Python program ends with `assay.serve(FUNCTION)`, which prints it; another program "
      "flushes what it prints";
};

/// Why a program did not answer: a sentence with the program's name, how it ended and the end of
/// its standard error.
class NoAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The program itself says, in the place of its hello, that it cannot be used so.
class Refused : public NoAnswer {
 public:
  using NoAnswer::NoAnswer;
};

/// A respondent answers questions about an estimator. It is a program, or a library in this
/// process.
class Respondent {
 public:
  virtual ~Respondent() = default;

  virtual const Hello& hello() const = 0;
  /// The numbers of the observations, one after the other. Throws NoAnswer, after which a program
  /// no longer runs.
  std::vector<double> ask(const Question& question) { return ask(question, {}); }
  /// The same of a question to a sampler, whose items follow it.
  std::vector<double> ask(const Question& question, std::string_view items);
  /// How many of the question's observations or items to ask for at a time, by how long the last
  /// replies to such questions took.
  std::uint64_t well_sized(const Question& question) const;
  /// True at the first question of as many primaries, or to the same sampler. What an examination
  /// asks beyond its own does not count.
  bool meets(const Question& question);
  /// CPU seconds that it has spent outside of the threads that ask.
  virtual double cpu_seconds() const { return 0; }
  virtual void close() {}
  /// Waits for that.
  virtual void ends_by(Deadline) {}

 private:
  virtual std::vector<double> hear(const Question& question, std::string_view items) = 0;
  void learn_pace(const Question& question, double seconds);

  /// Questions for observations of so many primaries, and to each sampler for what it is asked.
  using Kind = std::pair<std::uint64_t, std::uint64_t>;
  static Kind kind_of(const Question& question);

  std::map<Kind, std::uint64_t> sizes_;
  std::set<Kind> met_;
};

/// A running program.
class Dialogue final : public Respondent {
 public:
  /// Starts the program and reads its hello. Throws NoAnswer, Refused where it refuses.
  explicit Dialogue(const Terms& terms);

  const Hello& hello() const override { return hello_; }
  double cpu_seconds() const override { return child_.cpu_seconds(); }
  void close() override { child_.close_input(); }
  void ends_by(Deadline end) override { child_.ends_by(end); }

 private:
  void hear_hello();
  std::size_t listen(std::span<char> into, Deadline end);
  std::vector<double> hear(const Question& question, std::string_view items) override;
  std::vector<double> reply_to(const Question& question, std::string_view items);
  [[noreturn]] void give_up(const std::string& why, const std::string& came = "");

  const Terms& terms_;
  Child child_;
  Hello hello_;
};

}  // namespace assay::foreign
