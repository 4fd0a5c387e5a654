#include "harness/theta/constant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/question/question.h"
#include "harness/theta/theta.h"

namespace assay::harness {
namespace {

using reports::Verdict;

bool meets_claimed(const stats::Range& theta, const Regions& regions) {
  const stats::Range claimed = regions.claimed();
  return regions.proof() ? theta.low < claimed.high && theta.high > claimed.low
                         : theta.low <= claimed.high && theta.high >= claimed.low;
}

/// Hint at the commonest cause of constant observations.
std::string seeds(const Question& question) {
  for (const Subject& subject : question.subjects) {
    if (is_recorded(subject)) return "if they should vary, has each a seed of its own? ";
    if (subject.estimator->entry->information.says_nature) {
      return "if they should vary, does each draw its own random numbers? ";
    }
  }
  return "";
}

/// The spread that rounding may hide, by the size of the values or as declared.
double hidden_deviation(const Seen& seen) {
  const double averaged = seen.question.subjects[0].averaged(seen.data[0].primaries);
  const double size = std::abs(seen.moments(0).mean) * averaged;
  const double spacing = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return std::max(spacing, 2 * rounding_of(seen.question, 0, seen.channel));
}

}  // namespace

bool is_constant(const Question& question, std::size_t subject, std::size_t channel,
                 const stats::Moments& moments) {
  return moments.maximum - moments.minimum <= 2 * rounding_of(question, subject, channel);
}

double unseen_shift(const Seen& seen, std::size_t subject, double level) {
  const stats::Moments& x = seen.moments(subject);
  const stats::Range range = range_of(seen.question, subject, seen.channel, x);
  const double unseen = -std::expm1(std::log(level) / static_cast<double>(x.count));
  return unseen * std::max({0.0, x.mean - range.low, range.high - x.mean}) +
         rounding_of(seen.question, subject, seen.channel);
}

std::string range_advice(const Question& question) {
  return std::string(has_rows(question) ? "let a program draw the values instead of a file, and "
                                        : "") +
         "declare the range of its channel, `low` to `high`";
}

std::optional<ConstantVerdict> judge_constant(const Seen& seen, const Regions& regions) {
  const Question& question = seen.question;
  double rounding = 0;
  for (std::size_t subject = 0; subject < seen.data.size(); ++subject) {
    if (!is_constant(seen, subject)) return {};
    rounding += question.factor_of(subject) * rounding_of(question, subject, seen.channel);
  }
  const double reference =
      question.of_two() ? question.factor * seen.moments(1).mean : seen.reference().value;
  const double difference = seen.moments(0).mean - question.offset - reference;
  const double unit = seen.relative() && reference != 0 ? std::abs(reference) : 1;
  const stats::Range theta{.low = (difference - rounding) / unit,
                           .high = (difference + rounding) / unit};
  if (meets_claimed(theta, regions)) {
    if (!regions.has_forbidden()) {
      return ConstantVerdict{
          Verdict::pass,
          "every observation is the same and as claimed; values never seen are not ruled out"};
    }
    return ConstantVerdict{
        Verdict::inconclusive,
        "every observation is the same and as claimed, but what values never seen could add is "
        "bounded by no number of observations; " +
            range_advice(seen.question)};
  }
  return ConstantVerdict{
      Verdict::invalid,
      fmt::format("every observation is {:.10g}, off by {:.3g}: {}rare other values may be unseen, "
                  "and could make up for it; {}",
                  seen.moments(0).mean, difference, seeds(seen.question),
                  range_advice(seen.question))};
}

std::optional<ConstantVerdict> judge_constant_variance(const Seen& seen, const Regions& regions) {
  if (regions.relation != Relation::at_most || regions.has_forbidden() || !is_constant(seen, 0)) {
    return {};
  }
  const double hidden = hidden_deviation(seen);
  if (hidden * hidden > seen.reference().value) return {};
  return ConstantVerdict{Verdict::pass,
                         fmt::format("every observation is {:.10g}, so that no variance was seen "
                                     "that could be too large; values never seen are not ruled out",
                                     seen.moments(0).mean)};
}

std::string lack_of_variance(const Seen& seen) {
  const Question& question = seen.question;
  for (std::size_t subject = 0; subject < question.compared(); ++subject) {
    if (is_constant(seen, subject)) {
      return fmt::format(
          "every observation of `{}` is {:.10g} but for rounding: a sample without spread says "
          "nothing of a variance, and a rare value may be unseen; {}",
          question.subjects[subject].estimator->name, seen.moments(subject).mean,
          question.of_two() ? "compare the other with a number, or take more observations"
                            : "see that it uses its random numbers, or take more observations");
    }
  }
  return "";
}

}  // namespace assay::harness
