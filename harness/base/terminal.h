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

/// A line a minute, for what does not redraw lines: "assay: pilot  43 % (80 s left)  60 s".
class ProgressLines : public Progress {
 public:
  explicit ProgressLines(std::ostream& out, Clock now = std::chrono::steady_clock::now)
      : out_(out), now_(std::move(now)), first_(now_()), shown_(first_) {}
  void begin(const Phase& phase) override { phase_ = phase, began_ = now_(); }
  void advance(std::uint64_t done) override;

 protected:
  /// "pilot  43 % (80 s left)  60 s", with the time left of this phase and the time of all.
  std::string text(std::uint64_t done) const;

  std::ostream& out_;
  Clock now_;
  Phase phase_ = {};
  std::chrono::steady_clock::time_point first_;  ///< start of all phases
  std::chrono::steady_clock::time_point began_;  ///< start of this phase
  std::chrono::steady_clock::time_point shown_;
};

/// A line on standard error that redraws itself, ten times a second at most. It never scrolls.
class ProgressBar final : public ProgressLines {
 public:
  explicit ProgressBar(
      std::ostream& out, Clock now = std::chrono::steady_clock::now,
      std::function<int()> width = [] { return terminal_width(stderr); })
      : ProgressLines(out, std::move(now)), width_(std::move(width)) {}
  ~ProgressBar() override { ProgressBar::end(); }
  void begin(const Phase& phase) override;
  void advance(std::uint64_t done) override;
  void end() override;  ///< wipes the line

 private:
  void draw(std::uint64_t done);

  std::function<int()> width_;
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
