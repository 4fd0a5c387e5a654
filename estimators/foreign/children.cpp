#include "estimators/foreign/children.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace assay::foreign {

namespace {

// What a program may take to end by itself once its standard input is closed.
constexpr std::chrono::milliseconds farewell{500};

// Pairs of observations, and how many different ones must be among them, before equality under two
// keys is no coincidence: of a value with four outcomes it is at most some 3 in
// 10^6 (probabilities 3/4 and three of 1/12).
constexpr std::uint64_t most_pairs = 12;
constexpr std::size_t least_different = 4;

std::vector<double> one(Dialogue& dialogue, Question question, std::uint64_t index) {
  question.first = index;
  question.count = 1;
  return dialogue.ask(question);
}

/// Throws NoAnswer where the same observations come for another key. The first pair that differs
/// ends it: of continuous values that is the first.
void require_key_matters(Dialogue& dialogue, const Question& question, const std::string& name) {
  Question other = question;
  other.key = ~question.key;
  std::set<std::vector<double>> different;
  for (std::uint64_t index = 0; index < most_pairs; ++index) {
    const std::vector<double> mine = one(dialogue, question, index);
    if (!same_bits(one(dialogue, other, index), mine)) return;
    different.insert(mine);
  }
  if (different.size() < least_different) return;
  throw NoAnswer("`" + name +
                 "` gave the same numbers for two keys: runs of other "
                 "seeds would repeat each other, and so would estimators that must be independent; "
                 "seed its random numbers with key and index");
}

// Observations 0 to 19 that are all the same may be those of an estimator without variance, or of a
// rare event. They are not, where those of twice as many primaries are all the same too, but
// others: of a mean of independent primaries that is v with probability p, the mean of two such is
// v with p^2 at least, so that all of them come out so with probability at most (p (1 - p^2))^19 <=
// 2e-8.
constexpr std::uint64_t most_alike = 20;

/// All of the observations are the same numbers: these.
std::optional<std::vector<double>> always_given(Dialogue& dialogue, const Question& question) {
  const std::vector<double> first = one(dialogue, question, 0);
  for (std::uint64_t index = 1; index < most_alike; ++index) {
    if (!same_bits(one(dialogue, question, index), first)) return {};
  }
  return first;
}

/// But for what the sum of so many equal numbers in single precision loses.
bool same_but_for_rounding(const std::vector<double>& a, const std::vector<double>& b,
                           std::uint64_t primaries) {
  const double relative = 0x1p-24 * static_cast<double>(primaries);
  const auto near = [&](double x, double y) {
    return !std::isfinite(x) || !std::isfinite(y) ||
           std::abs(x - y) <= relative * std::max(std::abs(x), std::abs(y));
  };
  return std::ranges::equal(a, b, near);
}

/// Throws NoAnswer where the index of an observation changes nothing, though the number of
/// primaries does, whose mean it is said to be.
void require_index_matters(Dialogue& dialogue, const Question& question, const std::string& name) {
  if (!dialogue.hello().nature.averages) return;
  const auto once = always_given(dialogue, question);
  if (!once) return;
  Question twice_as_many = question;
  twice_as_many.primaries = 2 * question.primaries;
  const auto twice = always_given(dialogue, twice_as_many);
  if (!twice || same_but_for_rounding(*once, *twice, twice_as_many.primaries)) return;
  throw NoAnswer("`" + name + "` gave the same numbers for observations 0 to " +
                 std::to_string(most_alike - 1) + " of " + std::to_string(question.primaries) +
                 " primaries, and others for all of twice as many: they are not means of "
                 "independent primaries; seed its random numbers with key and index");
}

}  // namespace

Children::Children(Terms terms) : terms_(std::move(terms)) {
  idle_.push_back(std::make_unique<Dialogue>(terms_));
  hello_ = idle_.back()->hello();
}

Children::~Children() {
  for (const auto& dialogue : idle_) dialogue->child().close_input();
  const Deadline end = std::chrono::steady_clock::now() + farewell;
  for (const auto& dialogue : idle_) dialogue->child().ends_by(end);
}

std::unique_ptr<Dialogue> Children::take() {
  {
    const std::scoped_lock lock(mutex_);
    if (!idle_.empty()) {
      auto dialogue = std::move(idle_.back());
      idle_.pop_back();
      return dialogue;
    }
  }
  auto dialogue = std::make_unique<Dialogue>(terms_);
  if (to_text(dialogue->hello()) == to_text(hello_)) return dialogue;
  throw NoAnswer("`" + terms_.name + "` said another hello when it was started again");
}

void Children::give_back(std::unique_ptr<Dialogue> dialogue) {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(dialogue));
}

void Children::witness(Dialogue& dialogue, const Question& question,
                       const std::vector<double>& numbers) {
  Witness mine{question, numbers};
  bool first = false;
  {
    const std::scoped_lock lock(mutex_);
    first = !witness_;
    if (first) witness_ = mine;
    mine = *witness_;
  }
  if (first) examine(dialogue, question);
  if (same_bits(dialogue.ask(mine.question), mine.numbers)) return;
  throw NoAnswer("`" + terms_.name + "` gave other numbers when it was asked for observation " +
                 std::to_string(mine.question.first) +
                 " of the same key again: an observation must be a function of key and index "
                 "alone, so seed its random numbers with both for each");
}

void Children::examine(Dialogue& dialogue, const Question& question) {
  try {
    require_key_matters(dialogue, question, terms_.name);
    require_index_matters(dialogue, question, terms_.name);
  } catch (const NoAnswer& unfit) {
    const std::scoped_lock lock(mutex_);
    unfit_ = unfit.what();
    throw;
  }
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
  if (found != failures_.end() && question.first > found->second.index) {
    throw NoAnswer(found->second.why);
  }
}

}  // namespace assay::foreign
