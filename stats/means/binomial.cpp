#include "stats/means/binomial.h"

#include <cmath>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

void check_counts(const char* function, Successes observed) {
  check::at_least({function, "trials"}, observed.trials, 1);
  if (observed.successes > observed.trials) {
    check::fail({function, "successes"}, observed.successes, "at most trials");
  }
}

}  // namespace

TestResult binomial(Successes observed, double null_probability) {
  check_counts("binomial", observed);
  check::unit({"binomial", "null_probability"}, null_probability);
  const LogTails tails = binomial_tails(observed.successes, {observed.trials, null_probability});
  return {static_cast<double>(observed.successes),
          {"binomial", {static_cast<double>(observed.trials), null_probability}},
          tails.lower,
          tails.upper,
          Exactness::exact};
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

}  // namespace assay::stats
