#include "estimators/foreign/children.h"

#include <algorithm>
#include <span>

#include "estimators/core/thread_seconds.h"

namespace assay::foreign {

namespace {

// The time for a program to end by itself once its standard input is closed.
constexpr std::chrono::milliseconds farewell{500};
// Observations that a further program must have in common with the first one.
constexpr std::size_t asked_of_further = 2;

}  // namespace

Children::Children(std::string name, Start start)
    : name_(std::move(name)), start_(std::move(start)) {
  idle_.push_back(start_());
  hello_ = idle_.back()->hello();
}

Children::~Children() {
  for (const auto& dialogue : idle_) dialogue->close();
  const Deadline end = std::chrono::steady_clock::now() + farewell;
  for (const auto& dialogue : idle_) dialogue->ends_by(end);
}

std::unique_ptr<Respondent> Children::take() {
  {
    const std::scoped_lock lock(mutex_);
    if (!idle_.empty()) {
      auto dialogue = std::move(idle_.back());
      idle_.pop_back();
      return dialogue;
    }
  }
  std::unique_ptr<Respondent> dialogue = start_();
  if (to_text(dialogue->hello()) == to_text(hello_)) return dialogue;
  throw NoAnswer("`" + name_ + "` printed a different hello when it was started again");
}

void Children::give_back(std::unique_ptr<Respondent> dialogue) {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(dialogue));
}

/// True if the caller is to draw the first observations. Waits while another one draws them.
bool Children::is_to_draw(const Question& wanted) {
  std::unique_lock lock(mutex_);
  Known& known = known_[wanted.primaries];
  drawn_.wait(lock, [&] { return !known.being_drawn; });
  known.being_drawn = !known.complete;
  return known.being_drawn;
}

/// Ends the drawing of first observations. If they are not known, the next one who comes draws
/// them.
void Children::settle(std::uint64_t primaries, Known known) {
  const std::scoped_lock lock(mutex_);
  known_.at(primaries) = std::move(known);
  drawn_.notify_all();
}

Children::Known Children::known_of(std::uint64_t primaries) const {
  const std::scoped_lock lock(mutex_);
  return known_.at(primaries);
}

void Children::refuse_unless_empty(const std::string& why) {
  if (why.empty()) return;
  const std::scoped_lock lock(mutex_);
  unfit_ = why;
  throw NoAnswer(why);
}

bool Children::examine(Respondent& dialogue, const Question& wanted) {
  if (is_to_draw(wanted)) return examine_first(dialogue, wanted);
  FirstObservations few = known_of(wanted.primaries).first;
  few.numbers.resize(std::min(few.count(), asked_of_further) * few.width);
  const auto ask = [&](const Question& one) { return dialogue.ask(one); };
  refuse_unless_empty(why_not_repeated(ask, few, name_));
  return true;
}

bool Children::examine_first(Respondent& dialogue, const Question& wanted) {
  const std::size_t width = hello_.width();
  FirstObservations mine{.question = {.key = wanted.key,
                                      .first = 0,
                                      .count = asked_twice(width, wanted.primaries),
                                      .primaries = wanted.primaries},
                         .width = width};
  const bool one_by_one = known_of(wanted.primaries).one_by_one;
  Question last = mine.question;
  const auto ask = [&](const Question& question) { return dialogue.ask(last = question); };
  const auto spent = [&] { return thread_seconds() + dialogue.cpu_seconds(); };
  const double begin = spent();
  bool runs = true;
  try {
    while (mine.count() < mine.question.count) {
      Question next = mine.question;
      next.first = mine.count();
      next.count -= mine.count();
      next.count = one_by_one ? 1 : dialogue.well_sized(next);
      const std::vector<double> more = ask(next);
      mine.numbers.insert(mine.numbers.end(), more.begin(), more.end());
    }
  } catch (const NoAnswer& failure) {
    if (last.count > 1) {
      settle(wanted.primaries, {.one_by_one = true});
      return false;
    }
    note_failure(last, failure.what());
    runs = false;
  } catch (...) {
    settle(wanted.primaries, {});
    throw;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(mine.count(), 1));
  settle(wanted.primaries, {.first = mine,
                            .complete = true,
                            .seconds = (spent() - begin) / count,
                            .usual = mine.usual()});
  if (!runs) return false;
  refuse_unless_empty(why_not_repeated(ask, mine, name_));
  std::string why;
  try {
    why = why_unfit(ask, mine, name_, hello_.means());
  } catch (const NoAnswer& failure) {
    if (last.key == wanted.key) return false;
    why = failure.what();
  }
  refuse_unless_empty(why);
  return true;
}

Recalled Children::recalled(const Question& question) const {
  const std::scoped_lock lock(mutex_);
  const auto found = known_.find(question.primaries);
  if (found == known_.end() || !found->second.complete) return {};
  const FirstObservations& first = found->second.first;
  if (first.question.key != question.key || question.first >= first.count()) return {};
  const std::uint64_t count = std::min(question.count, first.count() - question.first);
  const double* const begin = first.numbers.data() + question.first * first.width;
  return {.numbers = {begin, begin + count * first.width},
          .count = count,
          .seconds = found->second.seconds * static_cast<double>(count)};
}

void Children::examine_unusual(Respondent& dialogue, const Question& question,
                               const std::vector<double>& numbers) {
  const std::optional<std::vector<double>> usual = known_of(question.primaries).usual;
  const std::optional<std::size_t> found = usual ? first_unusual(numbers, *usual) : std::nullopt;
  if (!found) return;
  const Question one = question.alone(*found);
  const std::size_t width = usual->size();
  const std::span<const double> unusual = std::span(numbers).subspan(*found * width, width);
  const bool same = same_bits(dialogue.ask(one), unusual);
  refuse_unless_empty(same ? "" : other_numbers(name_, one));
  const std::scoped_lock lock(mutex_);
  known_.at(question.primaries).usual.reset();
}

void Children::note_failure(const Question& at, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  const auto [found, is_new] = failures_.try_emplace({at.key, at.primaries}, at.first, why);
  if (!is_new && at.first < found->second.index) found->second = {at.first, why};
}

void Children::refuse_after_failure(const Question& question) const {
  const std::scoped_lock lock(mutex_);
  if (!unfit_.empty() && !question.is_to_sampler()) throw NoAnswer(unfit_);
  const auto found = failures_.find({question.key, question.primaries});
  if (found != failures_.end() && question.first >= found->second.index) {
    throw NoAnswer(found->second.why);
  }
}

}  // namespace assay::foreign
