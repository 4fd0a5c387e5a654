#include "stats/means/binomial.h"

#include <algorithm>
#include <cmath>

#include "stats/basics/check.h"
#include "stats/basics/search.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

double width_of(Range range) { return range.high - range.low; }

void check_range(const char* function, Range range) {
  check::finite({function, "low"}, range.low);
  check::finite({function, "high"}, range.high);
  check::positive({function, "high - low"}, width_of(range));
}

void check_counts(const char* function, Successes observed) {
  check::at_least({function, "trials"}, observed.trials, 1);
  if (observed.successes > observed.trials) {
    check::fail({function, "successes"}, observed.successes, "at most trials");
  }
}

void check_sample(const char* function, const TwoValued& x) {
  check_range(function, x.range);
  check_counts(function, x.high);
}

double mean_of(const TwoValued& x) {
  const double share = static_cast<double>(x.high.successes) / static_cast<double>(x.high.trials);
  return x.range.low + width_of(x.range) * share;
}

// The same sample with the names of its two values exchanged, for values -high and -low.
TwoValued mirrored(const TwoValued& x) {
  return {{-x.range.high, -x.range.low}, {x.high.trials - x.high.successes, x.high.trials}};
}

Trials trials_at(Successes observed, double probability) {
  return {observed.trials, std::clamp(probability, 0.0, 1.0)};
}

// ln p of "E x - scale E y >= offset", small when x has few high values and y many. On the null
// line p = start + slope q by the probability q of y. It lies inside [0, 1] from `first` to `last`.
double log_p_lower(const TwoValued& x, const TwoValued& y, Contrast null_value) {
  const double width = width_of(x.range);
  const double start = (null_value.offset + null_value.scale * y.range.low - x.range.low) / width;
  const double slope = null_value.scale * width_of(y.range) / width;
  const double first = std::max(0.0, -start / slope);
  const double last = std::min(1.0, (1 - start) / slope);
  if (first > last) return start > 0 ? special::lowest_log() : 0;
  // ln(A B), concave on the line. A maximum missed by 1e-9 of it is missed by second order.
  const auto log_product = [&](double q) {
    const double log_a = binomial_lower(x.high.successes, trials_at(x.high, start + slope * q));
    const double log_b = binomial_upper(y.high.successes, trials_at(y.high, q));
    return std::max(special::lowest_log(), log_a + log_b);
  };
  const double log_w = maximum(log_product, first, last).value;
  return special::clamp_log(log_w + std::log1p(-log_w));
}

double log_p_upper(const TwoValued& x, const TwoValued& y, Contrast null_value) {
  return log_p_lower(mirrored(x), mirrored(y), {null_value.scale, -null_value.offset});
}

}  // namespace

TestResult binomial(Successes observed, double null_probability) {
  check_counts("binomial", observed);
  check::unit({"binomial", "null_probability"}, null_probability);
  return binomial_within(observed, null_probability, 0);
}

TestResult binomial_within(Successes observed, double q, double error) {
  const Trials least = trials_at(observed, q - error);
  const Trials most = trials_at(observed, q + error);
  const double impossible = special::lowest_log();
  return {static_cast<double>(observed.successes),
          {"binomial", {static_cast<double>(observed.trials), trials_at(observed, q).probability}},
          q - error > 1 ? impossible : binomial_lower(observed.successes, least),
          q + error < 0 ? impossible : binomial_upper(observed.successes, most)};
}

Interval clopper_pearson(Successes observed, double confidence) {
  check_counts("clopper_pearson", observed);
  check::inside_unit({"clopper_pearson", "confidence"}, confidence);
  const double k = static_cast<double>(observed.successes);
  const double n = static_cast<double>(observed.trials);
  const double log_tail = std::log((1 - confidence) / 2);
  const bool none = observed.successes == 0;
  const bool all = observed.successes == observed.trials;
  return {none ? 0 : beta_quantile({Tail::lower, log_tail}, {k, n - k + 1}),
          all ? 1 : beta_quantile({Tail::upper, log_tail}, {k + 1, n - k}), confidence};
}

Evidence probability_evidence(const Successes& seen, double offset, double error) {
  const auto at = [=](double theta) { return binomial_within(seen, theta - offset, error); };
  const auto interval = [=](double confidence) -> Interval {
    const Interval q = clopper_pearson(seen, confidence);
    return {q.low + offset - error, q.high + offset + error, confidence};
  };
  const auto share = static_cast<double>(seen.successes) / static_cast<double>(seen.trials);
  return {.estimate = share + offset, .at = at, .interval = interval};
}

TwoValued two_valued(const Moments& x, Range range) {
  check_range("two_valued", range);
  check::at_least({"two_valued", "count"}, x.count, 1);
  for (const double end : {x.minimum, x.maximum}) {
    if (end != range.low && end != range.high) {
      check::fail({"two_valued", "value"}, end, "one of the two values");
    }
  }
  const double n = static_cast<double>(x.count);
  const double hits = n * ((x.mean - range.low) / width_of(range));
  const double whole = std::clamp(std::round(hits), 0.0, n);
  if (!(std::abs(hits - whole) <= 0.25)) {
    check::fail({"two_valued", "mean"}, x.mean,
                "that of the two values alone: some lie between them");
  }
  return {range, {static_cast<std::uint64_t>(whole), x.count}};
}

TestResult two_valued_mean(const TwoValued& x, double null_mean) {
  check_sample("two_valued_mean", x);
  check::finite({"two_valued_mean", "null_mean"}, null_mean);
  return binomial_within(x.high, (null_mean - x.range.low) / width_of(x.range), 0);
}

TestResult two_valued_contrast(const TwoValued& x, const TwoValued& y, Contrast null_value) {
  check_sample("two_valued_contrast", x);
  check_sample("two_valued_contrast", y);
  check::finite({"two_valued_contrast", "scale"}, null_value.scale);
  check::finite({"two_valued_contrast", "offset"}, null_value.offset);
  if (null_value.scale == 0) return two_valued_mean(x, null_value.offset);
  if (null_value.scale < 0) {
    return two_valued_contrast(x, mirrored(y), {-null_value.scale, null_value.offset});
  }
  return {mean_of(x) - null_value.scale * mean_of(y) - null_value.offset,
          {"bound", {}},
          log_p_lower(x, y, null_value),
          log_p_upper(x, y, null_value)};
}

Interval two_valued_difference_interval(const TwoValued& x, const TwoValued& y, double confidence) {
  check_sample("two_valued_difference_interval", x);
  check_sample("two_valued_difference_interval", y);
  check::inside_unit({"two_valued_difference_interval", "confidence"}, confidence);
  const double log_error = std::log((1 - confidence) / 2);
  const double centre = mean_of(x) - mean_of(y);
  const double least = x.range.low - y.range.high;
  const double most = x.range.high - y.range.low;
  const auto too_low = [&](double d) { return log_p_upper(x, y, {1, d}) <= log_error; };
  const auto too_high = [&](double d) { return log_p_lower(x, y, {1, d}) <= log_error; };
  return {too_low(least) ? halved_between(centre, least, too_low).outside : least,
          too_high(most) ? halved_between(centre, most, too_high).outside : most, confidence};
}

}  // namespace assay::stats
