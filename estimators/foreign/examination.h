#pragma once

// What is found by asking again: whether numbers are a function of what was asked, of another
// program and of a library that is called in this process alike.

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "estimators/foreign/reply.h"

namespace assay::foreign {

/// The numbers of a question for one observation, or item of a sampler.
using Asking = std::function<std::vector<double>(const Question&)>;

/// Why the observations of a program are worth nothing, as a sentence with its name; "" where
/// nothing speaks against them. Another key than the question's must give other numbers; of means
/// of so many primaries, which the first `means` numbers of an observation are said to be, another
/// index must.
std::string why_unfit(const Asking& ask, const Question& question, const std::string& name,
                      std::size_t means);

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
