#pragma once

#include <functional>
#include <span>

#include "stats/means/student_t.h"

namespace assay::stats {

// A number that a null hypothesis is about and that is known up to an error: r with standard error
// u >= 0. `turn`: where what is tested turns, as a squared bias does where the bias is 0; any value
// where it is monotone.
struct UncertainReference {
  Reference known;
  double turn = 0;
};

// Null hypothesis: that which log_p tests with the true numbers t in the places of the references.
// Normal references, independent of the sample and of one another. Of a test at level a a tenth
// goes to the references and the rest to the sample, which must reject for all t near them:
//   p = inf { a : max p(t) <= 0.9 a, |t_k - r_k| <= u_k c },  P(|Z| > c) = 0.1 a / K,
// (maximised over a confidence set: Berger & Boos 1994, J. Am. Stat. Assoc. 89; intervals of all
// references together by Bonferroni). P(p <= a) <= a whatever the size of u, where expanding in t
// asks that u be small. The maximum is over nine places of each interval and the turn. log_p(r)
// where all references are exact. Throws std::domain_error: a negative or non-finite error.
double log_p_over_references(const std::function<double(std::span<const double>)>& log_p,
                             std::span<const UncertainReference> references);

}  // namespace assay::stats
