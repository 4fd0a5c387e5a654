#include <cmath>
#include <limits>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/basics/search.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

// The equivalent tail below one half, where a log probability has all its digits.
LogTail smaller(LogTail tail) {
  if (tail.log_probability <= -std::numbers::ln2) return tail;
  const Tail other = tail.tail == Tail::lower ? Tail::upper : Tail::lower;
  return {other, log_complement(tail.log_probability)};
}

// The x > 0 at which `distance` is zero. It increases in x. The bracket grows from the guess by
// factors that square. Infinite or zero when the root is not representable.
template <class Function>
double positive_root(const Function& distance, double guess) {
  const bool below = distance(guess) < 0;
  double inside = guess;
  for (double factor = 1.02; factor < 1e200; factor *= factor) {
    const double next = below ? inside * factor : inside / factor;
    if (next > 1e300) return std::numeric_limits<double>::infinity();
    if (next < 1e-300) return 0;
    if ((distance(next) < 0) != below) {
      return root(distance, {inside, next}, 52);
    }
    inside = next;
  }
  return below ? std::numeric_limits<double>::infinity() : 0;
}

void check_tail(const char* function, LogTail tail) {
  if (!(tail.log_probability < 0) || std::isinf(tail.log_probability)) {
    check::fail({function, "log_probability"}, tail.log_probability, "below 0 and finite");
  }
}

// The quantile of a positive law given by its tails. The distance increases in x for either tail.
template <class Tails>
double positive_quantile(LogTail tail, double guess, const Tails& tails) {
  const LogTail small = smaller(tail);
  const auto distance = [&](double x) {
    const LogTails at = tails(x);
    return small.tail == Tail::lower ? at.lower - small.log_probability
                                     : small.log_probability - at.upper;
  };
  return positive_root(distance, guess);
}

template <class Tails>
double symmetric_quantile(LogTail tail, double guess, const Tails& tails) {
  const LogTail small = smaller(tail);
  if (small.log_probability >= -std::numbers::ln2) return 0;
  const auto distance = [&](double x) { return small.log_probability - tails(x).upper; };
  const double magnitude = positive_root(distance, guess);
  return small.tail == Tail::upper ? magnitude : -magnitude;
}

}  // namespace

double normal_quantile(LogTail tail) {
  check_tail("normal_quantile", tail);
  const double excess = -smaller(tail).log_probability - std::numbers::ln2;
  return symmetric_quantile(tail, std::sqrt(2 * excess) + 1e-8, normal_tails);
}

double student_t_quantile(LogTail tail, double degrees) {
  check_tail("student_t_quantile", tail);
  check::positive({"student_t_quantile", "degrees"}, degrees);
  const double start = std::abs(normal_quantile(tail)) + 1e-8;
  return symmetric_quantile(tail, start, [&](double t) { return student_t_tails(t, degrees); });
}

double chi_square_quantile(LogTail tail, double degrees) {
  check_tail("chi_square_quantile", tail);
  // Wilson & Hilferty (1931), good enough to start from.
  const double c = 2 / (9 * degrees);
  const double root = std::max(1 - c + normal_quantile(tail) * std::sqrt(c), 1e-3);
  return positive_quantile(tail, degrees * root * root * root,
                           [&](double x) { return chi_square_tails(x, degrees); });
}

double f_quantile(LogTail tail, FDegrees degrees) {
  check_tail("f_quantile", tail);
  return positive_quantile(tail, 1, [&](double f) { return f_tails(f, degrees); });
}

double beta_quantile(LogTail tail, BetaShape shape) {
  check_tail("beta_quantile", tail);
  check::positive({"beta_quantile", "alpha"}, shape.alpha);
  check::positive({"beta_quantile", "beta"}, shape.beta);
  const double odds = positive_quantile(tail, shape.alpha / shape.beta, [&](double ratio) {
    return special::beta_tails_at({1 / (1 + 1 / ratio), 1 / (1 + ratio)}, shape);
  });
  return 1 / (1 + 1 / odds);
}

double noncentral_chi_square_quantile(LogTail tail, Noncentral parameters) {
  check_tail("noncentral_chi_square_quantile", tail);
  return positive_quantile(tail, parameters.degrees + parameters.noncentrality,
                           [&](double x) { return noncentral_chi_square_tails(x, parameters); });
}

}  // namespace assay::stats
