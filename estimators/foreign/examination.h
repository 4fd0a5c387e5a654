#pragma once

// What is found by asking again: whether numbers are a function of what was asked, of another
// program and of a library that is called in this process alike.
//
// For each number of primaries that a set-up is asked for, the first observations are drawn:
//   - They are asked for again, one by one from the last. Other bits are an error.
//   - They are compared with the same ones of another key, pair by pair until two differ. They are
//     an error once so many equal pairs can be no coincidence.
//   - Where they are all the same, those of another key, and means of twice as many primaries, must
//     not be all the same too, but others: the index then changes nothing.
//   - Where they are all the same, the first other one that a test meets is asked for again.
//
// A sound estimator, whatever its values, is accused with a probability below 1e-6. Its 2n
// observations are exchangeable. Given their values, all n pairs are equal with a probability that
// is a product over the pairs, of (2k + 1) / (2i + 1): i pairs came before, k of them with the same
// value. It accuses below 5e-7 / 128, after one of 128 pairs at most. For a constant it is 1; for
// 4 ones among 128 it is too large, for 5 it is not. Let a value have probability p. That n
// observations are all this value, and n means of twice as many primaries all another, has a
// probability of at most (p (1 - p^2))^n: 3e-7 for 16.

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimators/foreign/reply.h"

namespace assay::foreign {

/// The numbers of a question for one observation, or item of a sampler.
using Asking = std::function<std::vector<double>(const Question&)>;

/// Observations 0, 1, … of one stream, of `width` numbers each.
struct FirstObservations {
  Question question;  ///< for all that were wanted; fewer may have come
  std::size_t width = 1;
  std::vector<double> numbers = {};

  std::size_t count() const { return numbers.size() / width; }
  std::vector<double> row(std::size_t index) const;
  /// The only value that there is, of one observation or more.
  std::optional<std::vector<double>> usual() const;
};

/// How many observations of so many numbers are drawn to be asked for again: 32 numbers' worth, but
/// two at least, since an image may take a minute.
std::uint64_t asked_twice(std::size_t width);

/// Why a program or library of this name gives no function of key and index, as it gave other
/// numbers when it was asked again; "" where it gave the same. What `ask` throws goes on.
std::string why_not_repeated(const Asking& ask, const FirstObservations& first,
                             const std::string& name);

/// Why the observations are worth nothing, as a sentence; "" where nothing speaks against them. The
/// first `means` numbers of an observation are said to be means of its primaries.
std::string why_unfit(const Asking& ask, const FirstObservations& first, const std::string& name,
                      std::size_t means);

/// Which of these observations, of as many numbers as `usual`, is the first that is not like it.
std::optional<std::size_t> first_unusual(std::span<const double> numbers,
                                         std::span<const double> usual);

/// That a question for one observation or item had other numbers when it was asked again.
std::string other_numbers(const std::string& name, const Question& question);

/// That one item of a question to a sampler had other numbers when it was asked for alone.
std::string other_numbers_alone(const std::string& name, const Question& question);

/// A look at the first of many questions, whichever thread asks it.
class FirstLook {
 public:
  /// Calls `why_not` at the first call of all, and throws LibraryError with what it returns, unless
  /// that is empty, then and at every later call.
  template <class WhyNot>
  void at(const WhyNot& why_not) {
    if (!passed_.load(std::memory_order_acquire)) look(why_not);
  }

 private:
  void look(const std::function<std::string()>& why_not);

  std::mutex mutex_;
  std::atomic<bool> passed_ = false;
  std::string why_not_;
};

}  // namespace assay::foreign
