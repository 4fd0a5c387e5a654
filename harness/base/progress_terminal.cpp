#include "harness/base/progress_terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>

namespace assay::harness {

namespace {

using namespace std::chrono_literals;

constexpr const char* wipe = "\r\033[K";
constexpr std::size_t bar_width = 30;
constexpr auto bar_period = 100ms;
constexpr auto line_period = 30s;

// Guards every line that is written to the terminal.
std::mutex terminal;
const std::ostream* bar_on = nullptr;

double fraction(std::uint64_t done, std::uint64_t total) {
  return total == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

std::string bar(double fraction) {
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(bar_width));
  return "[" + std::string(filled, '#') + std::string(bar_width - filled, '.') + "]";
}

/// The remaining seconds at the pace so far; "" before a pace is known.
std::string remaining(double fraction, std::chrono::duration<double> elapsed) {
  if (fraction < 0.02 || elapsed < 1s) return "";
  const double seconds = elapsed.count() * (1 - fraction) / fraction;
  return seconds < 90 ? fmt::format("  {:.0f} s left", seconds)
                      : fmt::format("  {:.0f} min left", seconds / 60);
}

bool environment_has(const char* name) {
  const char* value = std::getenv(name);
  return value && *value;
}

}  // namespace

std::string progress_text(const std::string& phase, std::uint64_t done, std::uint64_t total) {
  const char* unit = phase == "calibration" ? "runs" : "primaries";
  if (total == 0) return fmt::format("{}  {} {}", phase, done, unit);
  // Rounded down, so that 100 % means all.
  const int percent = static_cast<int>(100 * fraction(done, total));
  constexpr std::uint64_t million = 1'000'000;
  const auto millions = [](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(million);
  };
  if (total < million)
    return fmt::format("{}  {} %  {} of {} {}", phase, percent, done, total, unit);
  return fmt::format("{}  {} %  {:.1f} of {:.1f} million {}", phase, percent, millions(done),
                     millions(total), unit);
}

ProgressBar::ProgressBar(std::ostream& out, Clock now) : out_(out), now_(std::move(now)) {}

void ProgressBar::begin(const std::string& phase, std::uint64_t total) {
  phase_ = phase;
  total_ = total;
  done_ = 0;
  began_ = now_();
  draw();
}

void ProgressBar::advance(std::uint64_t done) {
  done_ = done;
  if (now_() - drawn_ >= bar_period) draw();
}

void ProgressBar::draw() {
  const std::scoped_lock lock(terminal);
  bar_on = &out_;
  drawn_ = now_();
  const double part = fraction(done_, total_);
  out_ << wipe << bar(part) << ' ' << progress_text(phase_, done_, total_)
       << remaining(part, drawn_ - began_) << std::flush;
}

void ProgressBar::end() {
  const std::scoped_lock lock(terminal);
  bar_on = nullptr;
  out_ << wipe << std::flush;
}

ProgressLines::ProgressLines(std::ostream& out, Clock now)
    : out_(out), now_(std::move(now)), said_(now_()) {}

void ProgressLines::begin(const std::string& phase, std::uint64_t total) {
  phase_ = phase;
  total_ = total;
}

void ProgressLines::advance(std::uint64_t done) {
  if (now_() - said_ < line_period) return;
  said_ = now_();
  const std::scoped_lock lock(terminal);
  out_ << "assay: " << progress_text(phase_, done, total_) << std::endl;
}

void say_beside_progress(const std::string& sentence, std::ostream& out) {
  const std::scoped_lock lock(terminal);
  out << (bar_on == &out ? wipe : "") << "assay: " << sentence << std::endl;
}

std::unique_ptr<Progress> make_progress(bool quiet) {
  if (quiet) return std::make_unique<Silence>();
  const char* term = std::getenv("TERM");
  const bool dumb = term && std::string_view(term) == "dumb";
  if (isatty(STDERR_FILENO) && !environment_has("CI") && !dumb) {
    return std::make_unique<ProgressBar>(std::cerr);
  }
  return std::make_unique<ProgressLines>(std::cerr);
}

}  // namespace assay::harness
