#include "estimators/foreign/isolated_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "estimators/core/flush_denormals.h"
#include "estimators/foreign/examination.h"
#include "estimators/foreign/words.h"

namespace assay::foreign {

namespace {

/// CPU seconds of programs, whichever sampler's, while they served this thread.
thread_local double seconds_of_programs = 0;

/// Counts a program's while it lives.
class Counted {
 public:
  explicit Counted(const Dialogue& dialogue)
      : dialogue_(dialogue), before_(dialogue.cpu_seconds()) {}
  ~Counted() { seconds_of_programs += dialogue_.cpu_seconds() - before_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  const Dialogue& dialogue_;
  double before_;
};

/// The question for one draw, as an observation of no primaries.
Question draw_of(const Stream& random) {
  return {.key = random.key().bits, .first = random.observation(), .count = 1, .primaries = 0};
}

SamplerDraw draw_from(const double* numbers) {
  return {.point = {numbers[0], numbers[1], numbers[2]},
          .density = numbers[3],
          .weight = numbers[4],
          .valid = numbers[5] != 0};
}

/// True if an item of a reply is whole: no NaN, and a draw ends with 0 or 1.
bool is_whole(std::span<const double> item) {
  if (item.size() > 1) {
    if (item.back() == 0) return true;  // there is no point
    if (item.back() != 1) return false;
  }
  return std::ranges::none_of(item, [](double number) { return std::isnan(number); });
}

}  // namespace

/// The items of a question, as they are sent.
struct IsolatedSampler::Items {
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

IsolatedSampler::IsolatedSampler(std::shared_ptr<Children> children, std::size_t index)
    : children_(std::move(children)), index_(index), note_(children_->hello().samplers.at(index)) {}

double IsolatedSampler::seconds_elsewhere() const { return seconds_of_programs; }

double IsolatedSampler::rounding() const {
  return note_.rounding > 0 ? note_.rounding : Sampler::rounding();
}

SamplerDraw IsolatedSampler::sample(Stream& random) const {
  SamplerDraw draw;
  samples({&random, 1}, {&draw, 1});
  for (std::size_t i = 0; i < item_words(Asked::draws); ++i) random();
  return draw;
}

double IsolatedSampler::density(const Point& point) const {
  double density = 0;
  densities({&point, 1}, {&density, 1});
  return density;
}

double IsolatedSampler::evaluate(const Point& point) const {
  double value = 0;
  evaluations({&point, 1}, {&value, 1});
  return value;
}

std::size_t IsolatedSampler::samples(std::span<const Stream> random,
                                     std::span<SamplerDraw> draws) const {
  const Question first = draw_of(random.front());
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
      draws[i] = draw_from(numbers.data() + i * numbers_of(Asked::draws));
    }
    return count;
  } catch (const NoAnswer& failure) {
    children_->note_failure(first, failure.what());
    throw;
  }
}

std::size_t IsolatedSampler::densities(std::span<const Point> points, std::span<double> out) const {
  return at_points(Asked::densities, points, out);
}

std::size_t IsolatedSampler::lobe_densities(int /*lobe*/, std::span<const Point> points,
                                            std::span<double> out) const {
  return densities(points, out);
}

std::size_t IsolatedSampler::evaluations(std::span<const Point> points,
                                         std::span<double> out) const {
  return at_points(Asked::evaluations, points, out);
}

std::size_t IsolatedSampler::at_points(Asked what, std::span<const Point> points,
                                       std::span<double> out) const {
  const std::vector<double> numbers =
      ask({what, {reinterpret_cast<const char*>(points.data()), points.size_bytes()}});
  std::ranges::copy(numbers, out.begin());
  return numbers.size();
}

/// About the first few; `items` becomes those.
std::vector<double> IsolatedSampler::ask_once(Items& items) const {
  const std::uint64_t denormals = FlushDenormals::is_on() ? denormals_flushed : 0;
  Question question{.key = index_,
                    .first = static_cast<std::uint64_t>(items.what) + denormals,
                    .count = items.size(),
                    .primaries = 0};
  std::unique_ptr<Dialogue> dialogue = children_->take();
  question.count = dialogue->well_sized(question);
  items = items.range(0, question.count);
  std::vector<double> numbers;
  {
    const Counted counted(*dialogue);
    if (dialogue->is_new_to(question)) witness(*dialogue, question, items);
    numbers = dialogue->ask(question, items.bytes);
    if (question.count > 1) require_alone(*dialogue, question, items, numbers);
  }
  require_whole(items, numbers);
  children_->give_back(std::move(dialogue));
  return numbers;
}

/// Asks for the last of the first many of each kind alone. A program that draws on from the state
/// of its random numbers gives others.
void IsolatedSampler::require_alone(Dialogue& dialogue, const Question& question,
                                    const Items& items, std::span<const double> numbers) const {
  {
    const std::scoped_lock lock(mutex_);
    if (asked_alone_.contains(items.what)) return;
  }
  Question last = question;
  last.count = 1;
  const Items item = items.range(items.size() - 1, 1);
  const std::vector<double> alone = dialogue.ask(last, item.bytes);
  const std::span<const double> among = numbers.last(alone.size());
  if (same_bits(alone, {among.begin(), among.end()})) {
    const std::scoped_lock lock(mutex_);
    asked_alone_.insert(items.what);
    return;
  }
  throw NoAnswer(other_numbers_alone(children_->terms().name, question));
}

void IsolatedSampler::require_whole(const Items& items, std::span<const double> numbers) const {
  const std::size_t size = numbers_of(items.what);
  for (std::size_t i = 0; i * size < numbers.size(); ++i) {
    const std::span<const double> item = numbers.subspan(i * size, size);
    if (is_whole(item)) continue;
    std::string words;
    for (const double number : item) words += (words.empty() ? "" : ", ") + text_of(number);
    throw NoAnswer("`" + children_->terms().name + "` gave " + words +
                   (size > 1 ? ", which is no draw: five numbers, and 1 for a point or 0 for none"
                             : ", which is no number"));
  }
}

/// Each program is asked for the very same as the first one, and that one twice.
void IsolatedSampler::witness(Dialogue& dialogue, const Question& question,
                              const Items& items) const {
  Question one = question;
  one.count = 1;
  Witness first{one, std::string(items.range(0, 1).bytes), {}};
  first.numbers = dialogue.ask(one, first.item);
  {
    const std::scoped_lock lock(mutex_);
    first = witnesses_.try_emplace(items.what, first).first->second;
  }
  if (same_bits(dialogue.ask(first.question, first.item), first.numbers)) return;
  throw NoAnswer(other_numbers(children_->terms().name, one));
}

std::vector<double> IsolatedSampler::ask(const Items& items) const {
  Items asked = items;
  try {
    return ask_once(asked);
  } catch (const NoAnswer& failure) {
    return narrowed(asked, failure);
  }
}

/// Asks a new program about the items one by one, up to the one that cannot be had. Throws where it
/// is the first; with the failure of all where each can be had.
std::vector<double> IsolatedSampler::narrowed(const Items& items, const NoAnswer& failure) const {
  const std::string name = "sampler `" + note_.name + "`";
  std::vector<double> numbers;
  for (std::size_t i = 0; i < items.size() && items.size() > 1; ++i) {
    Items one = items.range(i, 1);
    try {
      const std::vector<double> more = ask_once(one);
      numbers.insert(numbers.end(), more.begin(), more.end());
    } catch (const NoAnswer& alone) {
      if (i > 0) return numbers;
      throw NoAnswer(name + one.place(note_.domain) + ": " + alone.what());
    }
  }
  throw NoAnswer(name + items.place(note_.domain) + ": " + failure.what());
}

}  // namespace assay::foreign
