#include "estimators/foreign/setup.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "estimators/core/flush_denormals.h"
#include "estimators/core/mapped.h"
#include "estimators/core/quoting.h"
#include "estimators/core/thread_seconds.h"
#include "estimators/foreign/children.h"

namespace assay::foreign {

namespace {

/// Asks for one after the other, up to the one that cannot be had. Throws where that is the first,
/// and the failure of all where each can be had.
template <class AskOne>
std::vector<double> one_by_one(std::uint64_t count, const NoAnswer& failure, const AskOne& ask) {
  std::vector<double> numbers;
  for (std::uint64_t i = 0; i < count && count > 1; ++i) {
    try {
      const std::vector<double> more = ask(i);
      numbers.insert(numbers.end(), more.begin(), more.end());
    } catch (const NoAnswer&) {
      if (i == 0) throw;
      return numbers;
    }
  }
  throw failure;
}

/// A worker's: one running program, and the observations that it has fetched ahead.
class ForeignEstimator final : public Estimator {
 public:
  explicit ForeignEstimator(std::shared_ptr<Children> children)
      : children_(std::move(children)),
        width_(children_->hello().width()),
        tells_rays_(children_->hello().rays),
        samples_(children_->hello().image ? children_->hello().image->elements() : 1) {}

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
    cost.samples += primaries * samples_;
    if (tells_rays_) count_rays(row, wanted, cost);
  }

 private:
  bool holds(const Question& q) const {
    return held_.key == q.key && held_.primaries == q.primaries && q.first >= held_.first &&
           q.first - held_.first < held_.count && !numbers_.empty();
  }

  void count_rays(const double* row, const Question& question, Cost& cost) const {
    const double rays = row[width_ - 1];
    constexpr double most = 0x1p53;
    if (!(rays >= 0 && rays <= most && rays == std::floor(rays))) {
      throw NoAnswer("`" + children_->name() + "` says that " + to_text(question) + " took " +
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
      if (!dialogue_->meets(wanted)) return;
      const double seconds = seconds_elsewhere() + thread_seconds();
      const bool runs = children_->examine(*dialogue_, wanted);
      seconds_ -= seconds_elsewhere() + thread_seconds() - seconds;
      // Another worker's observation may have failed meanwhile.
      children_->refuse_after_failure(wanted);
      if (runs) return;
      drop();
    }
  }

  void drop() {
    if (dialogue_) seconds_ += dialogue_->cpu_seconds() - taken_at_;
    dialogue_.reset();
  }

  void fetch(const Question& wanted) {
    numbers_.clear();
    try {
      children_->refuse_after_failure(wanted);
      fetch_from(wanted);
    } catch (const NoAnswer& failure) {
      children_->note_failure(wanted, failure.what());
      throw;
    }
  }

  void fetch_from(const Question& wanted) {
    Question question = wanted;
    try {
      take(wanted);
      question.count = announced_.end_from({wanted.key}, wanted.first) - wanted.first;
      // Known observations cost what they cost when they were drawn.
      Recalled known = children_->recalled(question);
      seconds_ += known.seconds;
      question.count = known.count > 0 ? known.count : dialogue_->well_sized(question);
      numbers_ = known.count > 0 ? std::move(known.numbers) : ask(question);
    } catch (const NoAnswer& failure) {
      drop();
      const auto ask_one = [&](std::uint64_t i) { return ask_alone(question.alone(i)); };
      numbers_ = one_by_one(question.count, failure, ask_one);
      question.count = numbers_.size() / width_;
    }
    held_ = question;
  }

  std::vector<double> ask(const Question& question) {
    std::vector<double> numbers = dialogue_->ask(question);
    children_->examine_unusual(*dialogue_, question, numbers);
    return numbers;
  }

  /// Asks a new program for one observation of the question.
  std::vector<double> ask_alone(const Question& one) {
    try {
      take(one);
      return ask(one);
    } catch (const NoAnswer& alone) {
      drop();
      children_->note_failure(one, alone.what());
      throw;
    }
  }

  std::shared_ptr<Children> children_;
  std::size_t width_;
  bool tells_rays_;
  std::uint64_t samples_;  ///< that a primary takes
  std::unique_ptr<Respondent> dialogue_;
  double taken_at_ = 0;
  double seconds_ = 0;
  Announcement announced_;
  Question held_;
  std::vector<double> numbers_;
};

// ---- A sampler inside the program

/// CPU seconds of programs, whichever sampler's, while they served this thread.
thread_local double seconds_of_programs = 0;

/// Counts a program's while it lives.
class Counted {
 public:
  explicit Counted(const Respondent& dialogue)
      : dialogue_(dialogue), before_(dialogue.cpu_seconds()) {}
  ~Counted() { seconds_of_programs += dialogue_.cpu_seconds() - before_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  const Respondent& dialogue_;
  double before_;
};

/// True if an item of a reply is whole: no NaN, and a draw ends with 0 or 1.
bool is_whole(std::span<const double> item) {
  if (item.size() > 1) {
    if (item.back() == 0) return true;  // there is no point
    if (item.back() != 1) return false;
  }
  return std::ranges::none_of(item, [](double number) { return std::isnan(number); });
}

/// The items of a question to a sampler, as they are sent.
struct Items {
  Asked what;
  std::string_view bytes;

  std::size_t size() const { return bytes.size() / bytes_of_one(); }
  Items range(std::size_t first, std::size_t count) const {
    return {what, bytes.substr(first * bytes_of_one(), count * bytes_of_one())};
  }
  /// The place of a single item that is a point, in words.
  std::string place(Domain domain) const {
    if (what == Asked::draws || size() != 1) return "";
    Point point;
    std::memcpy(point.data(), bytes.data(), bytes.size());
    return " at " + text_of(point, domain);
  }

 private:
  std::size_t bytes_of_one() const { return 8 * item_words(what); }
};

/// Asks whoever is idle. Its draws are of streams whose key and observation are the next
/// two words of Assay's. NoAnswer, with the point in question, if the program ends, takes too long
/// or says something else. NoAnswer, too, if it answers differently when it is asked again.
class ForeignSampler final : public Sampler {
 public:
  /// The sampler that stands at this place in the hello.
  ForeignSampler(std::shared_ptr<Children> children, std::size_t index)
      : children_(std::move(children)),
        index_(index),
        note_(children_->hello().samplers.at(index)) {}

  Domain domain() const override { return note_.domain; }
  std::array<double, 2> bounds() const override { return note_.bounds; }
  double rounding() const override {
    return note_.rounding > 0 ? note_.rounding : Sampler::rounding();
  }
  double seconds_elsewhere() const override { return seconds_of_programs; }

  SamplerDraw sample(Stream& random) const override {
    SamplerDraw draw;
    samples({&random, 1}, {&draw, 1});
    for (std::size_t i = 0; i < item_words(Asked::draws); ++i) random();
    return draw;
  }
  double density(const Point& point) const override {
    double density = 0;
    densities({&point, 1}, {&density, 1});
    return density;
  }
  double evaluate(const Point& point) const override {
    double value = 0;
    evaluations({&point, 1}, {&value, 1});
    return value;
  }

  std::size_t samples(std::span<const Stream> random, std::span<SamplerDraw> draws) const override {
    // A draw is an observation of no primaries.
    const Question first{.key = random.front().key().bits,
                         .first = random.front().observation(),
                         .count = 1,
                         .primaries = 0};
    children_->refuse_after_failure(first);
    std::vector<std::uint64_t> words;
    for (Stream stream : random) {
      for (std::size_t i = 0; i < item_words(Asked::draws); ++i) words.push_back(stream());
    }
    try {
      const std::vector<double> numbers =
          ask({Asked::draws,
               {reinterpret_cast<const char*>(words.data()), sizeof words[0] * words.size()}});
      const std::size_t count = numbers.size() / numbers_of(Asked::draws);
      for (std::size_t i = 0; i < count; ++i) {
        const double* const x = numbers.data() + i * numbers_of(Asked::draws);
        draws[i] = {
            .point = {x[0], x[1], x[2]}, .density = x[3], .weight = x[4], .valid = x[5] != 0};
      }
      return count;
    } catch (const NoAnswer& failure) {
      children_->note_failure(first, failure.what());
      throw;
    }
  }
  std::size_t densities(std::span<const Point> points, std::span<double> out) const override {
    return at_points(Asked::densities, points, out);
  }
  std::size_t evaluations(std::span<const Point> points, std::span<double> out) const override {
    return at_points(Asked::evaluations, points, out);
  }

 private:
  std::size_t at_points(Asked what, std::span<const Point> points, std::span<double> out) const {
    const std::vector<double> numbers =
        ask({what, {reinterpret_cast<const char*>(points.data()), points.size_bytes()}});
    std::ranges::copy(numbers, out.begin());
    return numbers.size();
  }

  /// About the first few; `items` becomes those.
  std::vector<double> ask_once(Items& items) const {
    const std::uint64_t denormals = FlushDenormals::is_on() ? denormals_flushed : 0;
    Question question{.key = index_,
                      .first = static_cast<std::uint64_t>(items.what) + denormals,
                      .count = items.size(),
                      .primaries = 0};
    std::unique_ptr<Respondent> dialogue = children_->take();
    question.count = dialogue->well_sized(question);
    items = items.range(0, question.count);
    std::vector<double> numbers;
    {
      const Counted counted(*dialogue);
      if (dialogue->meets(question)) witness(*dialogue, question, items);
      numbers = dialogue->ask(question, items.bytes);
      if (question.count > 1) require_alone(*dialogue, question, items, numbers);
    }
    require_whole(items, numbers);
    children_->give_back(std::move(dialogue));
    return numbers;
  }

  /// Asks for the last of the first many of each kind alone. A program that draws on from the state
  /// of its random numbers gives others.
  void require_alone(Respondent& dialogue, const Question& question, const Items& items,
                     std::span<const double> numbers) const {
    {
      const std::scoped_lock lock(mutex_);
      if (asked_alone_.contains(items.what)) return;
    }
    const Items item = items.range(items.size() - 1, 1);
    const std::vector<double> alone = dialogue.ask(question.alone(0), item.bytes);
    if (same_bits(alone, numbers.last(alone.size()))) {
      const std::scoped_lock lock(mutex_);
      asked_alone_.insert(items.what);
      return;
    }
    throw NoAnswer(other_numbers_alone(children_->name(), question));
  }

  void require_whole(const Items& items, std::span<const double> numbers) const {
    const std::size_t size = numbers_of(items.what);
    for (std::size_t i = 0; i * size < numbers.size(); ++i) {
      const std::span<const double> item = numbers.subspan(i * size, size);
      if (is_whole(item)) continue;
      throw NoAnswer("`" + children_->name() + "` gave " + listed(mapped(item, shortest_text)) +
                     (size > 1 ? ", which is no draw: five numbers, and 1 for a point or 0 for none"
                               : ", which is no number"));
    }
  }

  /// Each program is asked for the very same as the first one, and that one twice.
  void witness(Respondent& dialogue, const Question& question, const Items& items) const {
    const Question one = question.alone(0);
    Witness first{one, std::string(items.range(0, 1).bytes), {}};
    first.numbers = dialogue.ask(one, first.item);
    {
      const std::scoped_lock lock(mutex_);
      first = witnesses_.try_emplace(items.what, first).first->second;
    }
    if (same_bits(dialogue.ask(first.question, first.item), first.numbers)) return;
    throw NoAnswer(other_numbers(children_->name(), one));
  }

  std::vector<double> ask(const Items& items) const {
    Items asked = items;
    try {
      return ask_once(asked);
    } catch (const NoAnswer& failure) {
      return narrowed(asked, failure);
    }
  }

  /// Asks a new program about the items one by one.
  std::vector<double> narrowed(const Items& items, const NoAnswer& failure) const {
    const auto at = [&](const Items& part, const NoAnswer& why) {
      return NoAnswer("sampler `" + note_.name + "`" + part.place(note_.domain) + ": " +
                      why.what());
    };
    return one_by_one(items.size(), at(items, failure), [&](std::uint64_t i) {
      Items one = items.range(i, 1);
      try {
        return ask_once(one);
      } catch (const NoAnswer& alone) {
        throw at(one, alone);
      }
    });
  }

  std::shared_ptr<Children> children_;
  std::size_t index_;
  SamplerNote note_;
  /// The first question of each kind, about one item, and its answer.
  struct Witness {
    Question question;
    std::string item;
    std::vector<double> numbers;
  };
  mutable std::mutex mutex_;
  mutable std::map<Asked, Witness> witnesses_;
  mutable std::set<Asked> asked_alone_;
};

}  // namespace

std::shared_ptr<const Setup> setup_of(std::shared_ptr<Children> children) {
  std::vector<NamedSampler> samplers;
  for (const SamplerNote& note : children->hello().samplers) {
    samplers.push_back({note.name, std::make_shared<ForeignSampler>(children, samplers.size())});
  }
  const Hello& hello = children->hello();
  return assay::setup_of(
      {.channels = hello.channels,
       .make = [children] { return std::make_unique<ForeignEstimator>(children); },
       .samplers = std::move(samplers),
       .image = hello.image,
       .elements = {hello.element},
       .nature = hello.nature});
}

std::string mend_of_program(const std::string& program, std::errc why) {
  if (why == std::errc::permission_denied) {
    return "; make it executable, in the suite's folder: `chmod +x " + shell_quoted(program) + "`";
  }
  if (why == std::errc::executable_format_error) {
    return "; a script begins with `#!` and its interpreter, as `#!/usr/bin/env python3`";
  }
  const std::vector<std::string_view> words = words_of(program);
  if (words.size() > 1) {
    return "; put commas between the words: `[" + listed({words.begin(), words.end()}) + "]`";
  }
  return program.find('/') == std::string::npos
             ? "; a program in the suite's folder is written `./" + program + "`"
             : "; the path starts at the suite's folder";
}

std::shared_ptr<const Setup> start(Terms terms, const Parameters& parameters,
                                   std::string_view name) {
  const std::string program = terms.launch.command.front();
  if (terms.name.empty()) terms.name = listed(terms.launch.command, " ");
  try {
    const auto shared = std::make_shared<const Terms>(std::move(terms));
    return setup_of(std::make_shared<Children>(
        shared->name, [shared] { return std::make_unique<Dialogue>(*shared); }));
  } catch (const Refused& refusal) {
    parameters.refuse(name, std::string("starts no estimator: ") + refusal.what());
  } catch (const std::system_error& failure) {
    parameters.refuse(name, "names the program `" + program +
                                "`, which cannot be started: " + failure.code().message() +
                                mend_of_program(program, std::errc(failure.code().value())));
  }
}

ParameterInformation timeout_parameter(const std::string& summary, const std::string& fallback) {
  return beside_draws(number_parameter("timeout", summary, fallback, {0, 1e6, true}, "s"));
}

ParameterInformation memory_parameter() {
  return beside_draws(
      number_parameter("memory", "the most address space that the program may use; 0 sets no limit",
                       "0", {0, 1e9}, "MiB"));
}

std::vector<ParameterInformation> terms_parameters() {
  return {timeout_parameter("how long a hello or a reply may take; Assay asks for about 20 ms of "
                            "observations at once",
                            "60"),
          memory_parameter()};
}

Terms read_terms(Parameters& parameters) {
  return {.launch = {.folder = parameters.folder(), .memory = parameters.number("memory")},
          .timeout = parameters.number("timeout")};
}

}  // namespace assay::foreign
