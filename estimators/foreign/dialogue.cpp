#include "estimators/foreign/dialogue.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "estimators/core/waiting.h"

namespace assay::foreign {

namespace {

using std::chrono::duration;
using std::chrono::steady_clock;

// A question is sized to be answered in about this time. It is long against a change between two
// programs (some 20 microseconds), and short against a time-out.
constexpr double pleasant_seconds = 0.02;
// Longer than most programs take to start and to reply.
constexpr int silent_seconds = 3;
constexpr std::size_t longest_hello = std::size_t{1} << 20;

std::string seconds_text(double seconds) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%g", seconds);
  return std::string(buffer.data()) + (seconds == 1 ? " second" : " seconds");
}

Deadline after(double seconds) {
  return steady_clock::now() +
         std::chrono::duration_cast<steady_clock::duration>(duration<double>(seconds));
}

}  // namespace

Dialogue::Dialogue(const Terms& terms) : terms_(terms), child_(terms.launch) {
  try {
    hear_hello();
  } catch (const TimeOut&) {
    give_up("did not print the line `ready` within " + seconds_text(terms_.timeout) + "; " +
            terms_.who_is_ready);
  } catch (const Refusal& refusal) {
    throw Refused(refusal.what());
  } catch (const ProtocolError& error) {
    give_up("cannot be understood: " + std::string(error.what()));
  }
}

/// Waits for bytes of its standard output. Where none come for a while the user is asked, once.
std::size_t Dialogue::listen(std::span<char> into, Deadline end) {
  const Deadline silence_ends = steady_clock::now() + std::chrono::seconds(silent_seconds);
  std::atomic_flag* const asked = terms_.asked_whether_it_flushes.get();
  if (asked == nullptr || asked->test() || silence_ends >= end) return child_.receive(into, end);
  try {
    return child_.receive(into, silence_ends);
  } catch (const TimeOut&) {
    if (!asked->test_and_set()) {
      notice("`" + terms_.name + "` has not replied for " + std::to_string(silent_seconds) +
             " s; does it flush its output (print(..., flush=True))? Assay waits for it: " +
             seconds_text(terms_.timeout) + " (`timeout`)");
    }
    return child_.receive(into, end);
  }
}

void Dialogue::hear_hello() {
  const Deadline end = after(terms_.timeout);
  std::string text;
  std::array<char, 4096> buffer{};
  while (!is_whole_hello(text)) {
    const std::size_t count = listen(buffer, end);
    if (count == 0) {
      const std::string said = text.empty() ? "" : "; it said `" + shown(text) + "`";
      const std::string how = child_.ending();
      // Its own words say more.
      const std::string errors = child_.last_errors();
      const bool lost = errors.find("No module named 'assay'") != std::string::npos;
      give_up(how + " before it printed the line `ready`" + said,
              lost             ? "PYTHONPATH needs share/assay/python or estimators/foreign/python"
              : errors.empty() ? terms_.who_is_ready
                               : "");
    }
    text.append(buffer.data(), count);
    if (text.size() > longest_hello) throw ProtocolError("its hello has no end");
    // Garbage is seen at once, not when the time is over.
    const std::size_t line = text.find('\n');
    if (line != std::string::npos && !words_of(text.substr(0, line)).empty() &&
        words_of(text.substr(0, line))[0] != "assay") {
      parse_hello(text);
    }
  }
  hello_ = parse_hello(text);
}

void Dialogue::give_up(const std::string& why, const std::string& came) {
  child_.kill();
  throw NoAnswer("`" + terms_.name + "` " + why + ending_with(child_.last_errors()) +
                 (came.empty() ? "" : "; " + came));
}

std::vector<double> Respondent::ask(const Question& question, std::string_view items) {
  const auto start = steady_clock::now();
  std::vector<double> numbers = hear(question, items);
  learn_pace(question, duration<double>(steady_clock::now() - start).count());
  return numbers;
}

std::vector<double> Dialogue::hear(const Question& question, std::string_view items) {
  try {
    return reply_to(question, items);
  } catch (const ProtocolError& error) {
    give_up("cannot be understood: " + std::string(error.what()));
  }
}

std::vector<double> Dialogue::reply_to(const Question& question, std::string_view items) {
  const std::size_t width =
      question.is_to_sampler() ? numbers_of(question.asked()) : hello_.width();
  Reply reply(question, width, hello_.numbers);
  Deadline end = after(terms_.timeout);
  bool reads = true;
  if (child_.has_output()) {
    std::array<char, 64> early{};
    const std::size_t count = child_.receive(early, end);
    if (count > 0) {
      throw ProtocolError("it wrote to standard output without being asked: `" +
                          shown({early.data(), count}) + "`");
    }
  }
  try {
    reads = child_.send(to_bytes(question, hello_.numbers) + std::string(items), end);
    // It will not answer a question that it has not read. It may be about to end, and say why.
    if (!reads) end = std::min(end, steady_clock::now() + std::chrono::milliseconds(500));
    while (true) {
      const std::size_t count = listen(reply.space(), end);
      if (count == 0) {
        give_up(child_.ending() + " instead of answering for " + to_text(question), reply.so_far());
      }
      if (reply.take(count)) break;
      if (child_.has_output()) continue;
      if (const std::string why = reply.ends_early(); !why.empty()) throw ProtocolError(why);
    }
  } catch (const TimeOut&) {
    if (!reads) give_up("closed its standard input instead of answering for " + to_text(question));
    give_up("did not answer for " + to_text(question) + " within " + seconds_text(terms_.timeout) +
                (terms_.asked_whether_it_flushes ? " (parameter `timeout`; does it flush its "
                                                   "output after each reply, or run for ever?)"
                                                 : " (parameter `timeout`)"),
            reply.so_far());
  }
  return reply.numbers();
}

Respondent::Kind Respondent::kind_of(const Question& question) {
  if (!question.is_to_sampler()) return {0, question.primaries};
  return {question.key + 1, static_cast<std::uint64_t>(question.asked())};
}

bool Respondent::meets(const Question& question) { return met_.insert(kind_of(question)).second; }

std::uint64_t Respondent::well_sized(const Question& question) const {
  const auto known = sizes_.find(kind_of(question));
  return std::min(known == sizes_.end() ? 1 : known->second, question.count);
}

void Respondent::learn_pace(const Question& question, double seconds) {
  constexpr std::uint64_t growth = 8;
  std::uint64_t& size = sizes_[kind_of(question)];
  const auto count = static_cast<double>(question.count);
  const double wanted = count * pleasant_seconds / std::max(seconds, 1e-9);
  // A small question tells little of large ones.
  const auto most = static_cast<double>(std::max(growth * question.count, size));
  size = static_cast<std::uint64_t>(std::clamp(wanted, 1.0, most));
}

}  // namespace assay::foreign
