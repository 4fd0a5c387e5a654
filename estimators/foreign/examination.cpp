#include "estimators/foreign/examination.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "estimators/foreign/shared_object.h"

namespace assay::foreign {

namespace {

// Pairs of observations, and how many different ones must be among them, before equality under two
// keys is no coincidence: of a value with four outcomes it is at most some 3 in
// 10^6 (probabilities 3/4 and three of 1/12).
constexpr std::uint64_t most_pairs = 12;
constexpr std::size_t least_different = 4;

std::vector<double> one(const Asking& ask, Question question, std::uint64_t index) {
  question.first = index;
  question.count = 1;
  return ask(question);
}

/// Whether the same observations come for another key. The first pair that differs ends it: of
/// continuous values that is the first.
bool ignores_key(const Asking& ask, const Question& question) {
  Question other = question;
  other.key = ~question.key;
  std::set<std::vector<double>> different;
  for (std::uint64_t index = 0; index < most_pairs; ++index) {
    const std::vector<double> mine = one(ask, question, index);
    if (!same_bits(one(ask, other, index), mine)) return false;
    different.insert(mine);
  }
  return different.size() >= least_different;
}

// Observations 0 to 19 that are all the same may be those of an estimator without variance, or of a
// rare event. They are not, where those of twice as many primaries are all the same too, but
// others: of a mean of independent primaries that is v with probability p, the mean of two such is
// v with p^2 at least, so that all of them come out so with probability at most (p (1 - p^2))^19 <=
// 2e-8.
constexpr std::uint64_t most_alike = 20;

/// The first so many numbers of all of the observations are the same: these. The rays behind them
/// are no means.
std::optional<std::vector<double>> always_given(const Asking& ask, const Question& question,
                                                std::size_t means) {
  const auto means_of = [&](std::uint64_t index) {
    std::vector<double> numbers = one(ask, question, index);
    numbers.resize(std::min(means, numbers.size()));
    return numbers;
  };
  const std::vector<double> first = means_of(0);
  for (std::uint64_t index = 1; index < most_alike; ++index) {
    if (!same_bits(means_of(index), first)) return {};
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

/// Whether the index of an observation changes nothing, though the number of primaries does, whose
/// mean it is said to be.
bool ignores_index(const Asking& ask, const Question& question, std::size_t means) {
  const auto once = always_given(ask, question, means);
  if (!once) return false;
  Question twice_as_many = question;
  twice_as_many.primaries = 2 * question.primaries;
  const auto twice = always_given(ask, twice_as_many, means);
  return twice && !same_but_for_rounding(*once, *twice, twice_as_many.primaries);
}

constexpr const char* rule =
    "an observation must be a function of key and index alone, so seed its random numbers with "
    "both for each";
constexpr const char* rule_of_samplers =
    "a draw must be a function of its stream alone, a density and an evaluation of their point";

std::string gave_other_numbers(const std::string& name, const std::string& asked_for) {
  return "`" + name + "` gave other numbers when it was asked for " + asked_for;
}

}  // namespace

std::string why_unfit(const Asking& ask, const Question& question, const std::string& name,
                      std::size_t means) {
  if (ignores_key(ask, question)) {
    return "`" + name +
           "` gave the same numbers for two keys: runs of other seeds would repeat each other, and "
           "so would estimators that must be independent; seed its random numbers with key and "
           "index";
  }
  if (means > 0 && ignores_index(ask, question, means)) {
    return "`" + name + "` gave the same numbers for observations 0 to " +
           std::to_string(most_alike - 1) + " of " + std::to_string(question.primaries) +
           " primaries, and others for all of twice as many: they are not means of independent "
           "primaries; seed its random numbers with key and index";
  }
  return "";
}

std::string other_numbers(const std::string& name, const Question& question) {
  return gave_other_numbers(
      name, to_text(question) + (question.is_to_sampler()
                                     ? std::string(" again: ") + rule_of_samplers
                                     : std::string(" of the same key again: ") + rule));
}

std::string other_numbers_alone(const std::string& name, const Question& question) {
  return gave_other_numbers(name, "one of " + to_text(question) + " alone: " + rule_of_samplers);
}

void FirstLook::look(const std::function<std::string()>& why_not) {
  const std::scoped_lock lock(mutex_);
  if (passed_) return;
  if (why_not_.empty()) why_not_ = why_not();
  if (!why_not_.empty()) throw LibraryError(why_not_);
  passed_.store(true, std::memory_order_release);
}

}  // namespace assay::foreign
