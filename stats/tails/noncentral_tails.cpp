#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "stats/basics/check.h"
#include "stats/basics/search.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

// Terms this far (in logarithm) below the largest are left out: e^-46 = 1e-20.
constexpr double negligible = 46;

// ---- Noncentral chi-square: a Poisson mixture of central laws

// P(X >= x) = sum_j Poisson(j; ncp/2) Q(nu/2 + j, x/2), and P for the lower tail. Both factors are
// log-concave in j. So the terms have one mode, and bisection finds it and the terms that count.
struct PoissonMixture {
  double half_x;
  double half_degrees;
  double rate;
  Tail tail;

  double log_weight(double j) const { return special::log_gamma_prefix(j + 1, rate, 1 / rate); }
  double log_central(double j) const {
    const LogTails tails = gamma_tails(half_x, half_degrees + j);
    return tail == Tail::lower ? tails.lower : tails.upper;
  }
  double log_term(double j) const { return log_weight(j) + log_central(j); }
};

// Sums from one edge to the other in the direction in which the central tail grows. All terms are
// positive.
//   Upwards:   Q(a+1, y) = Q(a, y) + y^a e^-y / Gamma(a+1).
//   Downwards: P(a-1, y) = P(a, y) + y^(a-1) e^-y / Gamma(a).
// It carries the products weight x tail and weight x increment over the largest term. They stay in
// range however small the tail; the factors alone would not.
double log_mixture(const PoissonMixture& mixture) {
  const auto log_term = [&](std::uint64_t j) { return mixture.log_term(static_cast<double>(j)); };
  const double y = mixture.half_x;
  const auto far = static_cast<std::uint64_t>(std::min(4 * (mixture.rate + y) + 400, 0x1p62));
  const auto mode =
      smallest_whole(0, far, [&](std::uint64_t j) { return log_term(j + 1) <= log_term(j); });
  const double peak = log_term(mode);
  const auto counts = [&](std::uint64_t j) { return log_term(j) > peak - negligible; };
  const double first = static_cast<double>(smallest_whole(0, mode, counts));
  const double low = std::max(0.0, first - 1);
  const double high = static_cast<double>(smallest_whole(mode, far, std::not_fn(counts)));
  const bool up = mixture.tail == Tail::upper;
  double j = up ? low : high;
  double term = std::exp(mixture.log_term(j) - peak);
  const double shape = mixture.half_degrees + (up ? j : j - 1);
  double increment =
      shape > 0
          ? std::exp(mixture.log_weight(j) + special::log_gamma_prefix(shape, y, 1 / shape) - peak)
          : 0;
  double sum = term;
  while (up ? j < high : j > low) {
    const double a = mixture.half_degrees + j;
    const double weight_ratio = up ? mixture.rate / (j + 1) : j / mixture.rate;
    const double tail_ratio = up ? y / (a + 1) : (a - 1) / y;
    term = weight_ratio * (term + increment);
    increment *= weight_ratio * tail_ratio;
    sum += term;
    j += up ? 1 : -1;
  }
  return peak + std::log(sum);
}

// ---- Noncentral t: an integral over the chi law of s

// ln of the integrand of P(T >= t) = int P(Z >= t s - delta) f(s) ds over u = ln s. Here nu s^2 ~
// chi-square, and factors without u are left out.
//   Density: f(u) = 2 (nu/2)^(nu/2) / Gamma(nu/2) exp(nu u - nu e^(2u) / 2).
struct UpperIntegrand {
  double t;
  Noncentral parameters;

  double operator()(double u) const {
    const double growth = std::expm1(2 * u);
    // 2 u - growth. Near 0 many degrees would magnify cancellation.
    const double fall = std::abs(growth) < 0.1 ? special::log1p_minus(growth) : 2 * u - growth;
    return parameters.degrees / 2 * fall + normal_upper(t * std::exp(u) - parameters.noncentrality);
  }
};

// The scale on which the integrand varies at u: 1 / sqrt(2 nu) by the chi law, 1 in t s by the
// normal one.
double scale_at(const UpperIntegrand& f, double u) {
  return 1 / (std::abs(f.t) * std::exp(u) + std::sqrt(2 * f.parameters.degrees));
}

// The maximum to within a tenth of that scale, which is enough to start from. The integrand is
// log-concave. If it still rises at `high` the maximum lies beyond.
double maximise(const UpperIntegrand& f, double low, double high) {
  const double rising = 0.1 / std::sqrt(f.parameters.degrees);
  while (f(high) > f(high - rising)) high += high - low;
  const double digits = std::clamp(std::log2(10 / scale_at(f, high)), 8.0, 26.0);
  return maximum(f, low, high, static_cast<int>(digits)).place;
}

// By the trapezoidal rule over w, u = centre + scale sinh w. So the integrand falls faster than any
// exponential on both sides, and steps of 1/16 err by 1e-13. For few degrees it falls slowly over
// u, like e^(nu u), on the side of small s.
double log_noncentral_upper(double t, Noncentral parameters) {
  constexpr double step = 1.0 / 16;
  const UpperIntegrand f{t, parameters};
  const double spread = 60 / std::sqrt(parameters.degrees) + 60 / parameters.degrees;
  const double centre = maximise(f, -spread - std::log1p(std::abs(t)), std::min(spread, 300.0));
  const double scale = scale_at(f, centre);
  const double peak = f(centre);
  double sum = 1;
  for (const double direction : {-1.0, 1.0}) {
    double term = 1;
    for (double w = step; term > 1e-18 * sum; w += step) {
      term = std::exp(f(centre + direction * scale * std::sinh(w)) - peak) * std::cosh(w);
      sum += term;
    }
  }
  const double half = parameters.degrees / 2;
  return std::log(2 * scale * step) + special::log_gamma_prefix(half, half) + peak + std::log(sum);
}

// The mixture has a hundred thousand terms and more beyond this. The saddlepoint's error is of
// order ncp^(-3/2).
constexpr double largest_mixture = 1e8;

// Barndorff-Nielsen's r* = w + ln(v / w) / w at the saddlepoint s of K(s) - s x. With 1 / (1 - 2s)
// = 1 + d:
//   K(s) = ncp s / (1 - 2s) - nu / 2 ln(1 - 2s).
//   And w^2 / 2 = ncp d^2 / 2 + nu / 2 (d - ln(1 + d)),   v = s sqrt K''(s).
LogTails saddlepoint_tails(double x, Noncentral parameters) {
  const auto [degrees, noncentrality] = parameters;
  const double beyond_mean = x - noncentrality - degrees;
  const double sum = 2 * noncentrality + degrees;
  const double d = 2 * beyond_mean / (sum + std::sqrt(sum * sum + 4 * noncentrality * beyond_mean));
  const double half_square = noncentrality * d * d / 2 + degrees * -special::log1p_minus(d) / 2;
  const double w = std::copysign(std::sqrt(2 * half_square), d);
  constexpr double near_the_mean = 1e-4;
  if (std::abs(w) < near_the_mean) {
    const double second = 2 * degrees + 4 * noncentrality;
    const double third = 8 * degrees + 24 * noncentrality;
    return normal_tails(w + third / (6 * second * std::sqrt(second)));
  }
  const double v = d / 2 * std::sqrt(2 * degrees + 4 * noncentrality * (1 + d));
  return normal_tails(w + std::log(v / w) / w);
}

}  // namespace

LogTails noncentral_chi_square_tails(double x, Noncentral parameters) {
  check::finite({"noncentral_chi_square_tails", "x"}, x);
  check::positive({"noncentral_chi_square_tails", "degrees"}, parameters.degrees);
  check::non_negative({"noncentral_chi_square_tails", "noncentrality"}, parameters.noncentrality);
  if (parameters.noncentrality == 0) return chi_square_tails(x, parameters.degrees);
  if (x <= 0) return special::from_lower(special::lowest_log());
  if (parameters.noncentrality > largest_mixture) return saddlepoint_tails(x, parameters);
  const Tail tail = x >= parameters.degrees + parameters.noncentrality ? Tail::upper : Tail::lower;
  const double log_p =
      log_mixture({x / 2, parameters.degrees / 2, parameters.noncentrality / 2, tail});
  return tail == Tail::upper ? special::from_upper(log_p) : special::from_lower(log_p);
}

LogTails noncentral_t_tails(double t, Noncentral parameters) {
  check::finite({"noncentral_t_tails", "t"}, t);
  check::positive({"noncentral_t_tails", "degrees"}, parameters.degrees);
  check::finite({"noncentral_t_tails", "noncentrality"}, parameters.noncentrality);
  if (t >= parameters.noncentrality) {
    return special::from_upper(log_noncentral_upper(t, parameters));
  }
  const Noncentral mirrored{parameters.degrees, -parameters.noncentrality};
  return special::from_lower(log_noncentral_upper(-t, mirrored));
}

}  // namespace assay::stats
