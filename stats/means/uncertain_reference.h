#pragma once

#include <functional>
#include <span>

#include "stats/means/student_t.h"

namespace assay::stats {

// A number in a null hypothesis that is known up to an error: r with standard error u >= 0. The
// tested quantity turns at `turn`, as a squared bias does at bias 0. If it is monotone any value
// will do.
struct UncertainReference {
  Reference known;
  double turn = 0;
};

// Null hypothesis: that of log_p, with the true numbers t in the places of the references.
// References are normal, independent of the sample and of one another. Of a level a, a tenth goes
// to the references and the rest to the sample. The sample must reject for all t near them. Here
// P(|Z| > c) = 0.1 a / K.
//   P-value: inf { a : max p(t) <= 0.9 a, |t_k - r_k| <= u_k c }.
// (Maximised over a confidence set: Berger & Boos 1994, J. Am. Stat. Assoc. 89; all references
// together by Bonferroni.) P(p <= a) <= a for any size of u. The maximum is over nine places of
// each interval and the turn. If all references are exact the result is log_p(r). Throws
// std::domain_error: a negative or non-finite error.
double log_p_over_references(const std::function<double(std::span<const double>)>& log_p,
                             std::span<const UncertainReference> references);

// The test with the known numbers in the places of the references. Its p-values are those above.
TestResult test_over_references(const std::function<TestResult(std::span<const double>)>& at,
                                std::span<const UncertainReference> references);

}  // namespace assay::stats
