#include "estimators/foreign/children.h"

#include <algorithm>
#include <cstring>
#include <set>

namespace assay::foreign {

namespace {

// What a program may take to end by itself once its standard input is closed.
constexpr std::chrono::milliseconds farewell{500};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// Pairs of observations, and how many different ones must be among them, before equality under two
// keys is no coincidence: of a value with four outcomes it is at most some 3 in
// 10^6 (probabilities 3/4 and three of 1/12).
constexpr std::uint64_t most_pairs = 12;
constexpr std::size_t least_different = 4;

/// Throws NoAnswer where the same observations come for another key. The first pair that differs
/// ends it: of continuous values that is the first.
void require_key_matters(Dialogue& dialogue, Question question, const std::string& name) {
  const std::uint64_t key = question.key;
  std::set<std::vector<double>> different;
  question.count = 1;
  for (std::uint64_t index = 0; index < most_pairs; ++index) {
    question.first = index;
    question.key = key;
    const std::vector<double> mine = dialogue.ask(question);
    question.key = ~key;
    if (!same_bits(dialogue.ask(question), mine)) return;
    different.insert(mine);
  }
  if (different.size() < least_different) return;
  throw NoAnswer("`" + name +
                 "` gave the same numbers for two keys: runs of other "
                 "seeds would repeat each other, and so would estimators that must be independent; "
                 "seed its random numbers with key and index");
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
  if (first) require_key_matters(dialogue, question, terms_.name);
  if (same_bits(dialogue.ask(mine.question), mine.numbers)) return;
  throw NoAnswer("`" + terms_.name + "` gave other numbers when it was asked for observation " +
                 std::to_string(mine.question.first) +
                 " of the same key again: an observation must be a function of key and index "
                 "alone, so seed its random numbers with both for each");
}

void Children::note_failure(const Question& at, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  const auto [found, is_new] = failures_.try_emplace({at.key, at.primaries}, at.first, why);
  if (!is_new && at.first < found->second.index) found->second = {at.first, why};
}

void Children::refuse_after_failure(const Question& question) const {
  const std::scoped_lock lock(mutex_);
  const auto found = failures_.find({question.key, question.primaries});
  if (found != failures_.end() && question.first > found->second.index) {
    throw NoAnswer(found->second.why);
  }
}

}  // namespace assay::foreign
