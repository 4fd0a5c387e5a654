#pragma once

// Progress on standard error.

#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <ostream>

#include "harness/base/progress.h"

namespace assay::harness {

using Clock = std::function<std::chrono::steady_clock::time_point()>;

/// A bar that redraws itself, ten times a second at most.
class ProgressBar final : public Progress {
 public:
  explicit ProgressBar(std::ostream& out, Clock now = std::chrono::steady_clock::now);
  void begin(const std::string& phase, std::uint64_t total) override;
  void advance(std::uint64_t done) override;
  void end() override;  ///< wipes the bar

 private:
  void draw();

  std::ostream& out_;
  Clock now_;
  std::string phase_;
  std::uint64_t total_ = 0;
  std::uint64_t done_ = 0;
  std::chrono::steady_clock::time_point began_;
  std::chrono::steady_clock::time_point drawn_;
};

/// A line when half a minute has passed without one: for logs, which cannot be redrawn.
class ProgressLines final : public Progress {
 public:
  explicit ProgressLines(std::ostream& out, Clock now = std::chrono::steady_clock::now);
  void begin(const std::string& phase, std::uint64_t total) override;
  void advance(std::uint64_t done) override;
  void end() override {}

 private:
  std::ostream& out_;
  Clock now_;
  std::string phase_;
  std::uint64_t total_ = 0;
  std::chrono::steady_clock::time_point said_;
};

/// Writes a line "assay: …". A bar on the same stream is wiped first and drawn again. Thread-safe.
void say_beside_progress(const std::string& sentence, std::ostream& out = std::cerr);

/// A bar when standard error is a terminal and CI is not set, lines otherwise, nothing when quiet.
std::unique_ptr<Progress> make_progress(bool quiet);

/// "sampling  43 %  1290 of 3000 primaries"; in millions from a million on; no percentage if total
/// is 0.
std::string progress_text(const std::string& phase, std::uint64_t done, std::uint64_t total);

}  // namespace assay::harness
