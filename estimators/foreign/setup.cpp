#include "estimators/foreign/setup.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "estimators/core/thread_seconds.h"
#include "estimators/foreign/isolated_sampler.h"
#include "estimators/foreign/words.h"

namespace assay::foreign {

namespace {

/// A worker's: one running program, and the observations that it has fetched ahead.
class ForeignEstimator final : public Estimator {
 public:
  explicit ForeignEstimator(std::shared_ptr<Children> children)
      : children_(std::move(children)), width_(children_->hello().width()) {}

  ~ForeignEstimator() override {
    if (dialogue_) children_->give_back(std::move(dialogue_));
  }
  ForeignEstimator(const ForeignEstimator&) = delete;
  ForeignEstimator& operator=(const ForeignEstimator&) = delete;

  void announce(const Announcement& what) override { announced_ = what; }
  double seconds_elsewhere() const override {
    return seconds_ + (dialogue_ ? dialogue_->cpu_seconds() - taken_at_ : 0);
  }

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    const Question wanted{.key = random.key().bits,
                          .first = random.observation(),
                          .count = 1,
                          .primaries = primaries};
    if (!holds(wanted)) fetch(wanted);
    const double* const row = numbers_.data() + (wanted.first - held_.first) * width_;
    std::copy_n(row, out.size(), out.begin());
    count_cost(row, wanted, cost);
  }

 private:
  bool holds(const Question& q) const {
    return held_.key == q.key && held_.primaries == q.primaries && q.first >= held_.first &&
           q.first - held_.first < held_.count && !numbers_.empty();
  }

  void count_cost(const double* row, const Question& question, Cost& cost) const {
    const std::optional<ImageShape>& image = children_->hello().image;
    cost.samples += question.primaries * (image ? image->elements() : 1);
    if (!children_->hello().rays) return;
    const double rays = row[width_ - 1];
    constexpr double most = 0x1p53;
    if (!(rays >= 0 && rays <= most && rays == std::floor(rays))) {
      throw NoAnswer("`" + children_->terms().name + "` says that " + to_text(question) + " took " +
                     std::to_string(rays) + " rays, which is no whole number");
    }
    cost.closest_hit_rays += static_cast<std::uint64_t>(rays);
  }

  /// A program that has been examined; what that took is not the estimator's.
  void take(const Question& wanted) {
    while (true) {
      if (!dialogue_) {
        dialogue_ = children_->take();
        taken_at_ = dialogue_->cpu_seconds();
      }
      if (!dialogue_->is_new_to(wanted)) return;
      const double seconds = seconds_elsewhere() + thread_seconds();
      const bool runs = children_->examine(*dialogue_, wanted);
      seconds_ -= seconds_elsewhere() + thread_seconds() - seconds;
      if (runs) return;
      drop();
      children_->refuse_after_failure(wanted);
    }
  }

  void drop() {
    if (dialogue_) seconds_ += dialogue_->cpu_seconds() - taken_at_;
    dialogue_.reset();
  }

  /// How far the caller has announced to go from here.
  std::uint64_t ahead(const Question& wanted) const {
    const bool announced = announced_.key.bits == wanted.key && wanted.first >= announced_.first &&
                           wanted.first < announced_.last;
    return announced ? announced_.last - wanted.first : 1;
  }

  void fetch(const Question& wanted) {
    children_->refuse_after_failure(wanted);
    numbers_.clear();
    Question question = wanted;
    try {
      take(wanted);
      question.count = ahead(wanted);
      if (!recall(question)) {
        question.count = dialogue_->well_sized(question);
        numbers_ = ask(question);
      }
    } catch (const NoAnswer& failure) {
      drop();
      if (question.count == 1) give_up(wanted, failure);
      question.count = narrowed(question, failure);
    }
    held_ = question;
  }

  /// True if the first of the observations are known; the question is then for these alone. They
  /// cost what they cost when they were drawn.
  bool recall(Question& question) {
    Recalled known = children_->recalled(question);
    if (known.count == 0) return false;
    numbers_ = std::move(known.numbers);
    question.count = known.count;
    seconds_ += known.seconds;
    return true;
  }

  std::vector<double> ask(const Question& question) {
    std::vector<double> numbers = dialogue_->ask(question);
    children_->examine_unusual(*dialogue_, question, numbers);
    return numbers;
  }

  /// Asks a new program for the observations one by one, up to the one that cannot be had: those
  /// before it are. Throws where it is the first; with the failure of all where each can be had.
  std::uint64_t narrowed(const Question& all, const NoAnswer& failure) {
    Question one = all;
    one.count = 1;
    for (std::uint64_t i = 0; i < all.count; ++i, ++one.first) {
      try {
        take(one);
        const std::vector<double> row = ask(one);
        numbers_.insert(numbers_.end(), row.begin(), row.end());
      } catch (const NoAnswer& alone) {
        drop();
        children_->note_failure(one, alone.what());
        if (i == 0) throw;
        return i;
      }
    }
    give_up(all, failure);
  }

  [[noreturn]] void give_up(const Question& at, const NoAnswer& failure) {
    numbers_.clear();
    children_->note_failure(at, failure.what());
    throw failure;
  }

  std::shared_ptr<Children> children_;
  std::size_t width_;
  std::unique_ptr<Dialogue> dialogue_;
  double taken_at_ = 0;
  double seconds_ = 0;
  Announcement announced_;
  Question held_;
  std::vector<double> numbers_;
};

}  // namespace

ForeignSetup::ForeignSetup(std::shared_ptr<Children> children) : children_(std::move(children)) {
  const std::vector<SamplerNote>& notes = children_->hello().samplers;
  for (std::size_t i = 0; i < notes.size(); ++i) {
    samplers_.push_back({notes[i].name, std::make_shared<IsolatedSampler>(children_, i)});
  }
}

std::unique_ptr<Estimator> ForeignSetup::make() const {
  return std::make_unique<ForeignEstimator>(children_);
}

std::shared_ptr<const Setup> start(Terms terms, const Parameters& parameters,
                                   std::string_view name) {
  const std::string program = terms.launch.command.front();
  if (terms.name.empty()) terms.name = joined(terms.launch.command);
  try {
    return std::make_shared<ForeignSetup>(std::make_shared<Children>(std::move(terms)));
  } catch (const Refused& refusal) {
    parameters.refuse(name, std::string("starts no estimator: ") + refusal.what());
  } catch (const std::system_error& failure) {
    const bool is_word = program.find('/') == std::string::npos;
    parameters.refuse(
        name, "names the program `" + program +
                  "`, which cannot be started: " + failure.code().message() +
                  (is_word ? "; a program in the suite's folder is written `./" + program + "`"
                           : "; it is sought from the suite's folder"));
  }
}

ParameterInformation timeout_parameter(const std::string& summary, const std::string& fallback) {
  return {.name = "timeout",
          .type = ParameterType::number,
          .summary = summary,
          .unit = "s",
          .fallback = fallback,
          .low = 0,
          .high = 1e6,
          .low_excluded = true,
          .shapes_draws = false};
}

ParameterInformation memory_parameter() {
  return {.name = "memory",
          .type = ParameterType::number,
          .summary = "the most address space that the program may take; 0 is no limit",
          .unit = "MiB",
          .fallback = "0",
          .low = 0,
          .high = 1e9,
          .shapes_draws = false};
}

std::vector<ParameterInformation> terms_parameters() {
  return {timeout_parameter("how long a hello or a reply may take; a question is made so large "
                            "that it is answered in some hundredths of a second, or asks for one "
                            "observation",
                            "60"),
          memory_parameter()};
}

Terms read_terms(Parameters& parameters) {
  return {.launch = {.folder = parameters.folder(), .memory = parameters.number("memory")},
          .timeout = parameters.number("timeout")};
}

}  // namespace assay::foreign
