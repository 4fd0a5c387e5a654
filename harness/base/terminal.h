#pragma once

// The terminal: its width, one line that follows the progress, and text beside that line.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <string>

#include "harness/base/work.h"

namespace assay::harness {

/// The value of a variable; "" where it is not set.
using Environment = std::function<std::string(const std::string&)>;

inline std::string system_environment(const std::string& variable) {
  const char* value = std::getenv(variable.c_str());
  return value == nullptr ? "" : value;
}

/// Columns of the terminal that the stream writes to. Else what COLUMNS says, else 80.
int terminal_width(std::FILE* stream);

/// The text after `lead`, in lines of 80 columns, or of the terminal's if it has fewer. Further
/// lines are indented as deep. Text in backticks stays unbroken, to be pasted.
std::string wrapped_message(const std::string& text, const std::string& lead);

/// A sentence so wrapped after `assay: `.
std::string in_lines(const std::string& sentence);

using Clock = std::function<std::chrono::steady_clock::time_point()>;

/// How far the work is: "pilot  43 % (80 s left)  60 s", with the time left of a phase and the time
/// of all. A terminal gets a bar that redraws itself, ten times a second at most, and never
/// scrolls. What does not redraw lines gets a line a minute.
class ProgressLine final : public Progress {
 public:
  ProgressLine(
      std::ostream& out, bool redraws, Clock now = std::chrono::steady_clock::now,
      std::function<int()> width = [] { return terminal_width(stderr); })
      : out_(out), redraws_(redraws), now_(std::move(now)), width_(std::move(width)) {}
  ~ProgressLine() override { ProgressLine::end(); }
  void begin(const Phase& phase) override;
  void advance(std::uint64_t done) override;
  void end() override;  ///< wipes the bar

 private:
  std::string text(std::uint64_t done) const;
  void draw(std::uint64_t done);

  std::ostream& out_;
  bool redraws_;
  Clock now_;
  std::function<int()> width_;
  Phase phase_ = {};
  std::chrono::steady_clock::time_point first_ = now_();  ///< start of all phases
  std::chrono::steady_clock::time_point began_ = first_;  ///< start of this phase
  std::chrono::steady_clock::time_point shown_ = first_;
};

/// Writes a line "assay: …" to standard error. A progress line is wiped first and drawn again
/// later. Thread-safe.
void say_beside_progress(const std::string& sentence, std::ostream& out = std::cerr);

/// The same for text that has its lines.
void write_beside_progress(const std::string& text, std::FILE* stream);

/// A bar when standard error is a terminal and CI is not set, else lines.
std::unique_ptr<Progress> make_progress(bool quiet);

/// "31 of 149 claims"; "pilot  43 %" of a phase without a unit.
std::string progress_text(const Phase& phase, std::uint64_t done);

}  // namespace assay::harness
