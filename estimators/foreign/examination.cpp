#include "estimators/foreign/examination.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

namespace assay::foreign {

namespace {

// Numbers that are drawn to be asked for again, and that are compared under another key.
constexpr std::size_t numbers_twice = 32;
constexpr std::size_t numbers_compared = 128;
// Fewest observations, however many numbers they have. Ten pairs of different values are enough.
constexpr std::size_t least_twice = 2;
constexpr std::size_t least_compared = 16;
// Pairs are judged after each: together they accuse with at most 5e-7.
constexpr double least_chance = 5e-7 / numbers_compared;

/// Observations that hold so many numbers.
std::size_t holding(std::size_t numbers, std::size_t width, std::size_t least) {
  return std::clamp(numbers / width, least, numbers);
}

/// Gives one observation of a stream by its index.
using Observations = std::function<std::vector<double>(std::size_t index)>;

/// True if the same observations come for another key. The first pair that differs ends it.
bool ignores_key(const Observations& source, const Observations& others, std::size_t most) {
  // That all pairs of exchangeable observations are equal, given their values.
  double probability = 1;
  std::map<std::size_t, double> pairs;  // by value; two values of one hash make it larger
  for (std::size_t i = 0; i < most; ++i) {
    const std::vector<double> mine = source(i);
    if (!same_bits(others(i), mine)) return false;
    const auto* const bytes = reinterpret_cast<const char*>(mine.data());
    double& earlier = pairs[std::hash<std::string_view>{}({bytes, sizeof(double) * mine.size()})];
    probability *= (2 * earlier++ + 1) / (2 * static_cast<double>(i) + 1);
    if (probability < least_chance) return true;
  }
  return false;
}

std::vector<double> begin_of(std::vector<double> row, std::size_t numbers) {
  row.resize(std::min(numbers, row.size()));
  return row;
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

/// True if the index of an observation changes nothing, though the question does. The first `count`
/// observations all begin with the same numbers, and the others all begin with different ones.
bool ignores_index(const Observations& source, const Observations& others, std::size_t numbers,
                   std::size_t count, std::uint64_t primaries) {
  const std::vector<double> mine = begin_of(source(0), numbers);
  const std::vector<double> other = begin_of(others(0), numbers);
  if (same_but_for_rounding(mine, other, primaries)) return false;
  for (std::size_t i = 1; i < count; ++i) {
    if (!same_bits(begin_of(source(i), numbers), mine)) return false;
    if (!same_bits(begin_of(others(i), numbers), other)) return false;
  }
  return true;
}

/// A program of the package `assay` knows neither key nor index.
const std::string seeding =
    "take random numbers only from a generator seeded with key and index (in Python: from `rng`)";
const std::string rule =
    "an observation must be a function of key and index alone (the run's seed sets the key): " +
    seeding + ", and add in one order whatever the threads do";
constexpr const char* rule_of_samplers =
    "a draw must depend on its stream alone, a density or an evaluation on its point alone";

std::string gave_other_numbers(const std::string& name, const std::string& asked_for) {
  return "`" + name + "` gave other numbers when it was asked for " + asked_for;
}

}  // namespace

std::vector<double> FirstObservations::row(std::size_t index) const {
  const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(index * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

std::optional<std::vector<double>> FirstObservations::usual() const {
  if (count() == 0 || first_unusual(numbers, row(0))) return {};
  return row(0);
}

std::uint64_t asked_twice(std::size_t width, std::uint64_t primaries) {
  return holding(numbers_twice, width * std::clamp<std::uint64_t>(primaries, 1, numbers_twice),
                 least_twice);
}

std::string why_not_repeated(const Asking& ask, const FirstObservations& first,
                             const std::string& name) {
  for (std::size_t i = first.count(); i-- > 0;) {
    const Question one = first.question.alone(i);
    if (!same_bits(ask(one), first.row(i))) return other_numbers(name, one);
  }
  return "";
}

std::string why_unfit(const Asking& ask, const FirstObservations& first, const std::string& name,
                      std::size_t means) {
  const std::uint64_t primaries = first.question.primaries;
  const auto of = [&](const Question& question) -> Observations {
    return [&ask, question](std::size_t index) { return ask(question.alone(index)); };
  };
  const auto source = [&, more = of(first.question)](std::size_t index) {
    return index < first.count() ? first.row(index) : more(index);
  };
  const Question& asked = first.question;
  const auto other_key = of({~asked.key, asked.first, asked.count, primaries});
  const auto twice_as_many = of({asked.key, asked.first, asked.count, 2 * primaries});
  const std::size_t most = holding(numbers_compared, first.width, least_compared);
  if (ignores_key(source, other_key, most)) {
    return "`" + name +
           "` gave the same numbers for two keys: runs of other seeds would repeat each other, and "
           "so would estimators that must be independent; " +
           seeding;
  }
  if (!first.usual()) return "";
  const std::size_t count = std::min(numbers_twice, most);
  const std::string same =
      "`" + name + "` ignores the index: observations 0 to " + std::to_string(count - 1);
  const std::string again =
      " they all have the same ones again, but others than before; " + seeding;
  if (ignores_index(source, other_key, first.width, count, primaries)) {
    return same + " all have the same numbers; under another key" + again;
  }
  if (means > 0 && ignores_index(source, twice_as_many, means, count, 2 * primaries)) {
    return same + ", means of " + std::to_string(primaries) +
           (primaries == 1 ? " primary" : " primaries") +
           ", all have the same numbers; as means of " + std::to_string(2 * primaries) +
           " primaries" + again;
  }
  return "";
}

std::optional<std::size_t> first_unusual(std::span<const double> numbers,
                                         std::span<const double> usual) {
  for (std::size_t i = 0; i * usual.size() < numbers.size(); ++i) {
    if (!same_bits(numbers.subspan(i * usual.size(), usual.size()), usual)) return i;
  }
  return {};
}

std::string other_numbers(const std::string& name, const Question& question) {
  return gave_other_numbers(
      name, to_text(question) + " again: " + (question.is_to_sampler() ? rule_of_samplers : rule));
}

std::string other_numbers_alone(const std::string& name, const Question& question) {
  return gave_other_numbers(name, "one of " + to_text(question) + " alone: " + rule_of_samplers);
}

}  // namespace assay::foreign
