#pragma once

// Internal: a continued fraction b_0 + a_1 / (b_1 + a_2 / (b_2 + ...)). The recurrence of its
// convergents A_n / B_n needs no division a term: A_n = b_n A_(n-1) + a_n A_(n-2), B likewise.

namespace assay::stats::special {

struct Convergents {
  double before = 1;
  double now = 1;  ///< A_n
  double inverse_before = 0;
  double inverse_now = 1;  ///< B_n

  /// Takes the term a_n / b_n.
  void add(double numerator, double denominator) {
    const double later = denominator * now + numerator * before;
    const double inverse_later = denominator * inverse_now + numerator * inverse_before;
    before = now;
    inverse_before = inverse_now;
    now = later;
    inverse_now = inverse_later;
  }

  /// One over the fraction so far, B_n / A_n. Rescales, so that nothing overflows.
  double reciprocal() {
    const double scale = 1 / now;
    before *= scale;
    inverse_before *= scale;
    inverse_now *= scale;
    now = 1;
    return inverse_now;
  }
};

}  // namespace assay::stats::special
