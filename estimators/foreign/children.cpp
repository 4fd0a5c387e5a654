#include "estimators/foreign/children.h"

#include "estimators/foreign/examination.h"

namespace assay::foreign {

namespace {

// What a program may take to end by itself once its standard input is closed.
constexpr std::chrono::milliseconds farewell{500};

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
  throw NoAnswer(other_numbers(terms_.name, mine.question));
}

void Children::examine(Dialogue& dialogue, const Question& question) {
  try {
    const auto ask = [&](const Question& one) { return dialogue.ask(one); };
    const std::string why = why_unfit(ask, question, terms_.name, hello_.means());
    if (!why.empty()) throw NoAnswer(why);
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
