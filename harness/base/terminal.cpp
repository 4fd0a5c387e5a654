#include "harness/base/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>

#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::harness {

namespace {

using namespace std::chrono_literals;

/// The end of the piece that begins at `begin`: the next blank outside backticks.
std::size_t end_of_piece(const std::string& text, std::size_t begin) {
  std::size_t end = begin;
  for (bool quoted = false; end < text.size() && (quoted || text[end] != ' '); ++end) {
    // A backtick that is never closed does not quote.
    if (text[end] == '`') quoted = !quoted && text.find('`', end + 1) != std::string::npos;
  }
  return end;
}

constexpr const char* wipe = "\r\033[K";
constexpr std::chrono::milliseconds bar_period = 100ms;
constexpr std::chrono::milliseconds line_period = 1min;

// Guards every line that is written to the terminal.
std::mutex terminal;
std::ostream* bar_on = nullptr;

double fraction(const Phase& phase, std::uint64_t done) {
  return phase.total == 0
             ? 0
             : std::min(1.0, static_cast<double>(done) / static_cast<double>(phase.total));
}

void wipe_bar() {
  if (bar_on != nullptr) *bar_on << wipe << std::flush;
}

}  // namespace

std::string wrapped_message(const std::string& text, const std::string& lead) {
  std::string out;
  std::string line = lead;
  const int width = std::min(80, terminal_width(stderr));
  bool is_new = true;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = end_of_piece(text, begin);
    const std::string piece = text.substr(begin, end - begin);
    if (!is_new && reports::columns(line + " " + piece) > width) {
      out += line + "\n";
      line = std::string(lead.size(), ' ');
      is_new = true;
    }
    line += (is_new ? "" : " ") + piece;
    is_new = false;
    begin = end + 1;
  }
  return out + line + "\n";
}

std::string in_lines(const std::string& sentence) {
  const std::size_t end = std::min(sentence.find('\n'), sentence.size());
  std::string out = wrapped_message(sentence.substr(0, end), "assay: ");
  // Text that already has lines, such as another program's, keeps them.
  if (end < sentence.size()) out += sentence.substr(end + 1) + "\n";
  return out;
}

int terminal_width(std::FILE* stream) {
  winsize size{};
  if (ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  constexpr int usual = 80;
  const int given = std::atoi(system_environment("COLUMNS").c_str());
  return given > 0 ? given : usual;
}

std::string progress_text(const Phase& phase, std::uint64_t done) {
  const std::string name = phase.name.empty() ? "" : phase.name + "  ";
  if (!phase.unit.empty()) return fmt::format("{}{} of {} {}", name, done, phase.total, phase.unit);
  // Rounded down, so that 100 % means all.
  return fmt::format("{}{} %", name, static_cast<int>(100 * fraction(phase, done)));
}

std::string ProgressLine::text(std::uint64_t done) const {
  const std::chrono::duration<double> all = shown_ - first_, here = shown_ - began_;
  const double part = fraction(phase_, done);
  std::string left;
  if (phase_.unit.empty() && part > 0)  // claims take unequal times
    left = fmt::format(" ({} left)", reports::duration(here.count() * (1 / part - 1)));
  return fmt::format("{}{}  {:.0f} s", progress_text(phase_, done), reports::plain_spaces(left),
                     all.count());
}

void ProgressLine::begin(const Phase& phase) {
  phase_ = phase;
  began_ = now_();
  if (redraws_) draw(0);
}

void ProgressLine::advance(std::uint64_t done) {
  if (now_() - shown_ >= (redraws_ ? bar_period : line_period)) draw(done);
}

void ProgressLine::draw(std::uint64_t done) {
  if (phase_.total == 0) return;
  shown_ = now_();
  if (!redraws_) return say_beside_progress(text(done), out_);
  constexpr int widest = 30;
  const std::scoped_lock lock(terminal);
  bar_on = &out_;
  // The last column stays free: some terminals begin a line after it.
  const int width = width_() - 1;
  const int room = std::min(widest, width / 3);
  std::string bar(static_cast<std::size_t>(room), '.');
  std::fill_n(bar.begin(), static_cast<int>(fraction(phase_, done) * room), '#');
  out_ << wipe << reports::shorten(fmt::format("[{}] {}", bar, text(done)), width) << std::flush;
}

void ProgressLine::end() {
  if (!redraws_) return;
  const std::scoped_lock lock(terminal);
  wipe_bar();
  bar_on = nullptr;
}

void say_beside_progress(const std::string& sentence, std::ostream& out) {
  const std::scoped_lock lock(terminal);
  wipe_bar();
  out << in_lines(sentence) << std::flush;
}

void write_beside_progress(const std::string& text, std::FILE* stream) {
  const std::scoped_lock lock(terminal);
  wipe_bar();
  fmt::print(stream, "{}", text);
  std::fflush(stream);
}

std::unique_ptr<Progress> make_progress(bool quiet) {
  if (quiet) return std::make_unique<Progress>();
  const bool redraws = isatty(STDERR_FILENO) && system_environment("TERM") != "dumb" &&
                       system_environment("CI").empty();
  return std::make_unique<ProgressLine>(std::cerr, redraws);
}

}  // namespace assay::harness
