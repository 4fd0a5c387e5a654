#pragma once

// Asking again shows if numbers are a function of the question. This is for programs, and for a
// library that is called in this process.
//
// The first observations are drawn for each number of primaries.
//   * They are asked for again, one by one from the last. Other bits are an error.
//   * They are compared with the same ones of another key, pair by pair until two differ. Too many
//     equal pairs for a coincidence are an error.
//   * If all are one value, those of another key must not all be another value. Nor may means of
//     twice as many primaries: the index would change nothing. The first other value that a test
//     meets is asked for again.
//
// A sound estimator is accused with a probability below 1e-6, whatever its values. Its 2n
// observations are exchangeable. Given their values, the probability that all n pairs are equal is
// a product over the pairs. The factor is (2k + 1) / (2i + 1): i pairs came before, k of them with
// the same value. The limit is 5e-7 / 128, for each of 128 pairs at most. A constant has 1. With 4
// ones among 128 it is above the limit, with 5 below. Let a value have probability p. Then n
// observations are all this value, and n means of twice as many primaries all another, with
// probability (p (1 - p^2))^n at most. That is 3e-7 for 16.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimators/foreign/protocol.h"

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

/// Number of observations of `width` numbers that are asked for twice: `32 / (width * primaries)`,
/// but at least two. An image may take a minute.
std::uint64_t asked_twice(std::size_t width, std::uint64_t primaries);

/// A sentence if a program or library of this name gives other numbers when it is asked again, else
/// "". An exception of `ask` goes on.
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

}  // namespace assay::foreign
