#include "stats/tails/kolmogorov.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "stats/basics/check.h"
#include "stats/basics/search.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

// ---- One-sided, Birnbaum & Tingey: d sum_j C(n, j) (d + j/n)^(j-1) (1 - d - j/n)^(n-j)

// ln of term j without the leading d. In deviance form, with x = j/n, the powers and the binomial
// coefficient are e^(-n KL(x || x + d)) up to Stirling's errors.
double log_one_sided_term(double n, double d, double j) {
  const double x = j / n;
  const double up = x + d;
  if (j == 0) return n * std::log1p(-d) - std::log(d);
  if (!(1 - up > 0)) return special::lowest_log();
  const double rest = n - j;
  const double binomial = special::stirling_error(n) - special::stirling_error(j) -
                          special::stirling_error(rest) -
                          0.5 * std::log(2 * std::numbers::pi * j * (rest / n));
  // Ratios are (j/n + d) / (j/n) and (1 - x - d) / (1 - x). Their linear parts n d cancel.
  return binomial + special::log_deviance(j, 1 + d / x) +
         special::log_deviance(rest, 1 - d / (1 - x)) - std::log(up);
}

// From here on the sum takes every s-th term times s. The terms are a smooth function of j that
// vanishes with all derivatives at both ends. So it converges faster than any power.
constexpr double densest_sum = 4000;

// ---- Durbin

// The result is ln P(D <= d). P is n! / n^n times an entry of the n-th power of Durbin's
// (2k-1) x (2k-1) matrix, k = floor(n d) + 1. (Marsaglia, Tsang & Wang 2003, equation 1.) Entries
// are 1 / (i - j + 1)! below the superdiagonal. The first column and last row are reduced by powers
// of h = k - n d. By this part of a step the boundary misses the lattice. The powers are taken of a
// column, and nothing in them cancels. So the result keeps about 13 digits. Cost 40 n k.
double log_durbin_lower(double distance, std::uint64_t n) {
  constexpr std::size_t most = 20;  // 1 / 20! is 4e-19.
  const double values = static_cast<double>(n);
  const double t = values * distance;
  const auto k = static_cast<std::size_t>(t) + 1;
  const double h = static_cast<double>(k) - t;
  const std::size_t size = 2 * k - 1;
  const auto powers_over_factorials = [&](double x) {
    std::vector<double> terms{1};
    for (std::size_t g = 1; g <= std::max(size, most); ++g) {
      terms.push_back(terms.back() * x / static_cast<double>(g));
    }
    return terms;
  };
  const std::vector<double> entry = powers_over_factorials(1);
  const std::vector<double> missed = powers_over_factorials(h);
  const double missed_twice = powers_over_factorials(std::max(0.0, 2 * h - 1))[size];
  std::vector<double> column(size);
  std::vector<double> next(size);
  column[k - 1] = 1;
  double log_p = std::lgamma(values + 1) - values * std::log(values);
  for (std::uint64_t power = 0; power < n; ++power) {
    std::copy(column.begin() + 1, column.end(), next.begin());
    next.back() = 0;
    for (std::size_t g = 1; g <= std::min(size, most); ++g) {
      for (std::size_t j = 0; j + g <= size; ++j) next[j + g - 1] += entry[g] * column[j];
    }
    for (std::size_t i = 0; i < size; ++i) {
      next[i] -= missed[i + 1] * column[0];
      next[size - 1] -= missed[size - i] * column[i];
    }
    next[size - 1] += missed_twice * column[0];
    const double sum = std::accumulate(next.begin(), next.end(), 0.0);
    log_p += std::log(sum);
    std::ranges::transform(next, column.begin(), [&](double each) { return each / sum; });
  }
  return log_p + std::log(column[k - 1]);
}

// ---- Pelz & Good

constexpr double pi2 = std::numbers::pi * std::numbers::pi;
constexpr double pi4 = pi2 * pi2;
constexpr double pi6 = pi4 * pi2;

// P(D <= d) by the expansion K0(z) + K1(z) / n^(1/2) + K2(z) / n + K3(z) / n^(3/2) at z =
// sqrt(n) d. (Pelz & Good, JRSS B 38 (1976) 152, equations 6 to 10.) Absolute error of order n^-2.
double pelz_good_lower(double distance, std::uint64_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double z = root * distance;
  const double z2 = z * z;
  const double z3 = z2 * z;
  const double z4 = z2 * z2;
  const double z6 = z4 * z2;
  // Terms are symmetric in k, hence the factors two.
  double half0 = 0, half1 = 0, half2 = 0, half3 = 0, whole2 = 0, whole3 = 0;
  // exp(-pi^2 k^2 / (2 z^2)) < 1e-20 beyond this.
  const double last = std::ceil(z * 3.1) + 1;
  for (double k = 0; k <= last; ++k) {
    const double c = (k + 0.5) * (k + 0.5);
    const double weight = 2 * std::exp(-pi2 * c / (2 * z2));
    half0 += weight;
    half1 += weight * (pi2 * c - z2);
    half2 += weight * (6 * z6 + 2 * z4 + pi2 * (2 * z4 - 5 * z2) * c + pi4 * (1 - 2 * z2) * c * c);
    half3 += weight * (pi6 * c * c * c * (5 - 30 * z2) + pi4 * c * c * (-60 * z2 + 212 * z4) +
                       pi2 * c * (135 * z4 - 96 * z6) - 30 * z6 - 90 * z4 * z4);
    const double d = k * k;
    const double of_whole = 2 * std::exp(-pi2 * d / (2 * z2));
    whole2 += of_whole * pi2 * d;
    whole3 += of_whole * (3 * pi2 * d * z2 - pi4 * d * d);
  }
  const double factor = std::sqrt(std::numbers::pi / 2);
  const double k0 = half0 * std::sqrt(2 * std::numbers::pi) / (2 * z);
  const double k1 = factor * half1 / (6 * z2 * z2);
  const double k2 = factor * (half2 / (72 * z3 * z3 * z) - whole2 / (36 * z3));
  const double k3 = factor * (half3 / (6480 * z3 * z3 * z3 * z) + whole3 / (216 * z3 * z3));
  return std::clamp(k0 + (k1 + (k2 + k3 / root) / root) / root, 0.0, 1.0);
}

// ---- Two-sided

// P(D >= d) = 2 P(D+ >= d) - P(both sides cross). To the leading order in 1/n the second is 2 e^(-8
// z^2) - 2 e^(-18 z^2). Here z = sqrt(n) d + 1 / (6 sqrt n), Pelz & Good's shift.
double log_upper_from_one_sided(double d, std::uint64_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double z = root * d + 1 / (6 * root);
  const double one = std::numbers::ln2 + log_smirnov_one_sided(d, n);
  const double both = std::numbers::ln2 - 8 * z * z + std::log1p(-std::exp(-10 * z * z));
  return d >= 0.5 ? one : one + std::log1p(-std::exp(both - one));
}

// Bounds between the forms; n d^2 is the square of the limit law's argument. The corrected upper
// tail is within 2e-9 relative of Durbin's matrix from n d^2 = 3 on for n > 500. From 4 on it is
// within 2e-10 for every n. The expansion is within 4e-9 where the matrix is not used.
double upper_tail_from(std::uint64_t n) { return n <= 500 ? 4 : 3; }

// Milliseconds. That is the body of the law for n up to 2000.
constexpr double most_for_durbin = 2e5;

}  // namespace

double log_smirnov_one_sided(double distance, std::uint64_t n) {
  check::at_least({"log_smirnov_one_sided", "n"}, n, 1);
  check::unit({"log_smirnov_one_sided", "distance"}, distance);
  if (distance == 0) return 0;
  if (distance == 1) return special::lowest_log();
  const double size = static_cast<double>(n);
  const double last = std::min(std::floor(size * (1 - distance)), size - 1);
  const double stride = last < 2 * densest_sum ? 1 : std::floor(last / densest_sum);
  std::vector<double> logs;
  for (double j = 0; j <= last; j += stride) logs.push_back(log_one_sided_term(size, distance, j));
  const double log_sum = special::log_sum_of(logs) + std::log(stride);
  return special::clamp_log(std::log(distance) + log_sum);
}

double log_kolmogorov_limit(double z) {
  if (!(z >= 0)) check::fail({"log_kolmogorov_limit", "z"}, z, "at least 0");
  if (z < 1) {
    // Jacobi's dual series for the lower tail: sqrt(2 pi) / z sum e^(-(2k-1)^2 pi^2 / (8 z^2)).
    if (z < 0.04) return 0;
    const double q = -std::numbers::pi * std::numbers::pi / (8 * z * z);
    const double sum = std::exp(q) + std::exp(9 * q) + std::exp(25 * q);
    return std::log1p(-std::sqrt(2 * std::numbers::pi) / z * sum);
  }
  const double square = z * z;
  const double rest = -std::exp(-6 * square) + std::exp(-16 * square) - std::exp(-30 * square);
  return std::max(std::numbers::ln2 - 2 * square + std::log1p(rest), special::lowest_log());
}

LogTails kolmogorov_tails(double distance, std::uint64_t n) {
  check::at_least({"kolmogorov_tails", "n"}, n, 1);
  check::unit({"kolmogorov_tails", "distance"}, distance);
  const double size = static_cast<double>(n);
  const double t = size * distance;
  if (t <= 0.5) return special::from_lower(special::lowest_log());
  if (distance == 1) return special::from_upper(special::lowest_log());
  // n! ((2 t - 1) / n)^n.
  if (t <= 1) {
    return special::from_lower(std::lgamma(size + 1) + size * std::log((2 * t - 1) / size));
  }
  if (distance >= 0.5 || t * distance >= upper_tail_from(n)) {
    return special::from_upper(log_upper_from_one_sided(distance, n));
  }
  return special::from_lower(size * t <= most_for_durbin ? log_durbin_lower(distance, n)
                                                         : std::log(pelz_good_lower(distance, n)));
}

double kolmogorov_upper_quantile(double log_probability, std::uint64_t n) {
  check::at_least({"kolmogorov_upper_quantile", "n"}, n, 1);
  if (!(log_probability < 0) || std::isinf(log_probability)) {
    check::fail({"kolmogorov_upper_quantile", "log_probability"}, log_probability, "below 0");
  }
  const double size = static_cast<double>(n);
  // Massart's bound 2 e^(-2 n d^2) lies above the law, so the quantile is at most its inverse.
  const double bound = std::sqrt((std::numbers::ln2 - log_probability) / (2 * size));
  const double highest = std::min(1.0, bound * (1 + 1e-12));
  const auto excess = [&](double d) { return log_probability - kolmogorov_tails(d, n).upper; };
  // The upper side is the conservative one.
  return root_bracket(excess, 0.5 / size, highest, 44).second;
}

namespace {

constexpr std::int64_t most_places = 200'000'000;
constexpr double least_log_p = -20000;

// ---- m = n: P = 2 sum_i (-1)^(i-1) C(2n, n - i k) / C(2n, n)

// ln C(2n, n - r) / C(2n, n), in deviance form: absolute error of a few ulps of the result.
double log_relative_binomial(double n, double r) {
  if (r == n) return 2 * std::lgamma(n + 1) - std::lgamma(2 * n + 1);
  const double up = n + r;
  const double down = n - r;
  return 2 * special::stirling_error(n) - special::stirling_error(up) -
         special::stirling_error(down) - 0.5 * (std::log1p(r / n) + std::log1p(-r / n)) +
         special::log_deviance(up, n / up) + special::log_deviance(down, n / down);
}

// Nested: A_1 (1 - A_2/A_1 (1 - A_3/A_2 (…))).
double log_equal_sizes(std::uint64_t steps, std::uint64_t n) {
  const double size = static_cast<double>(n);
  const double k = static_cast<double>(steps);
  const double first = log_relative_binomial(size, k);
  double nested = 1;
  // Terms below e^-50 of the first change nothing.
  double last = 1;
  while ((last + 1) * k <= size && log_relative_binomial(size, (last + 1) * k) > first - 50) ++last;
  for (double i = last; i > 1; --i) {
    const double ratio =
        std::exp(log_relative_binomial(size, i * k) - log_relative_binomial(size, (i - 1) * k));
    nested = 1 - ratio * nested;
  }
  return std::numbers::ln2 + first + std::log(nested);
}

// ---- Otherwise: the share of paths that have touched the boundary

// After k pooled values, the places (i, k - i) of paths that may not have touched the boundary.
struct Band {
  std::int64_t first = 0;
  std::int64_t last = 0;

  std::int64_t places() const { return last + 1 - first; }
};

class Lattice {
 public:
  Lattice(const LatticeDistance& distance, std::span<const TiedRun> ties)
      : m_(static_cast<std::int64_t>(distance.m)),
        n_(static_cast<std::int64_t>(distance.n)),
        up_(n_ / std::gcd(m_, n_)),
        down_(m_ / std::gcd(m_, n_)),
        bound_(static_cast<std::int64_t>(distance.steps)),
        ties_(ties) {}

  // Calls visit(k, reached, left) for k = 1 .. m + n. Untouched paths come to the places `reached`,
  // and stay untouched at those `left`. The walk ends where visit returns false.
  template <class Visit>
  void walk(const Visit& visit) const {
    Band left;
    auto run = ties_.begin();
    for (std::int64_t k = 1; k <= m_ + n_; ++k) {
      const Band reached{std::max(left.first, k - n_), std::min(left.last + 1, m_)};
      while (run != ties_.end() && end_of(*run) <= k) ++run;
      const bool inside_a_run = run != ties_.end() && static_cast<std::int64_t>(run->before) < k;
      left = inside_a_run ? reached : inside(k, reached);
      if (!visit(k, reached, left)) return;
    }
  }

  // True if the bands have at most so many places.
  bool is_within(std::int64_t places) const {
    walk([&](std::int64_t, const Band& reached, const Band&) {
      places -= reached.places();
      return places >= 0 && reached.places() > 0;
    });
    return places >= 0;
  }

  // v(i, j) is 1 where a path has touched, else (i v(i-1, j) + j v(i, j-1)) / (i + j). Only sums of
  // positive terms. `Real` holds `one` in place of 1, so that the smallest path probability is in
  // range.
  template <class Real>
  Real touching_probability(Real one) const {
    std::vector<Real> v(static_cast<std::size_t>(m_) + 2, one);
    Real* const at = v.data() + 1;  // at[-1] has the weight 0.
    at[0] = 0;
    walk([&](std::int64_t k, const Band& reached, const Band& left) {
      const Real share = 1 / static_cast<Real>(k);
      for (std::int64_t i = reached.last; i >= reached.first; --i) {
        at[i] = share * (static_cast<Real>(i) * at[i - 1] + static_cast<Real>(k - i) * at[i]);
      }
      if (left.places() <= 0) {
        at[m_] = one;
        return false;
      }
      std::fill(at + reached.first, at + left.first, one);
      std::fill(at + left.last + 1, at + reached.last + 1, one);
      return true;
    });
    return at[m_];
  }

 private:
  static std::int64_t end_of(const TiedRun& run) {
    return static_cast<std::int64_t>(run.before + run.size);
  }

  Band inside(std::int64_t k, Band band) const {
    const auto gap = [&](std::int64_t i) { return i * up_ - (k - i) * down_; };
    while (band.places() > 0 && gap(band.first) <= -bound_) ++band.first;
    while (band.places() > 0 && gap(band.last) >= bound_) --band.last;
    return band;
  }

  std::int64_t m_;
  std::int64_t n_;
  std::int64_t up_;
  std::int64_t down_;
  std::int64_t bound_;
  std::span<const TiedRun> ties_;
};

double log_limit(const LatticeDistance& distance) {
  const double m = static_cast<double>(distance.m);
  const double n = static_cast<double>(distance.n);
  return log_kolmogorov_limit(std::sqrt(m / (m + n) * n) * distance.value());
}

double log_lattice(const Lattice& lattice, double expected) {
  // The limit law tells if a double will do. Denormal numbers would be slow as well as wrong.
  if (expected > -400) {
    const double p = lattice.touching_probability<double>(1.0);
    if (p > 1e-250) return std::log(p);
  }
  // A long double's range from 2^16000 down covers least_log_p.
  constexpr int raised = 16000;
  const long double q = lattice.touching_probability<long double>(std::ldexp(1.0L, raised));
  return static_cast<double>(std::log(q) - raised * std::numbers::ln2_v<long double>);
}

void check_ties(const LatticeDistance& distance, std::span<const TiedRun> ties) {
  std::uint64_t end = 0;
  for (const TiedRun& run : ties) {
    check::at_least({"smirnov_upper_tail", "begin of a run"}, run.before, end);
    end = run.before + run.size;
  }
  check::at_least({"smirnov_upper_tail", "pooled values"}, distance.m + distance.n, end);
}

double log_massart(double a, std::uint64_t n) {
  if (a <= 0) return 0;
  return std::min(0.0, std::numbers::ln2 - 2 * static_cast<double>(n) * a * a);
}

}  // namespace

double LatticeDistance::value() const {
  const double common = static_cast<double>(std::gcd(m, n));
  return static_cast<double>(steps) * (common / static_cast<double>(m)) / static_cast<double>(n);
}

double smirnov_upper_tail(LatticeDistance distance, std::span<const TiedRun> ties) {
  check::at_least({"smirnov_upper_tail", "m"}, distance.m, 1);
  check::at_least({"smirnov_upper_tail", "n"}, distance.n, 1);
  const double m = static_cast<double>(distance.m);
  const double n = static_cast<double>(distance.n);
  const std::uint64_t common = std::gcd(distance.m, distance.n);
  if (m / static_cast<double>(common) * n > 0x1p62) {
    check::fail({"smirnov_upper_tail", "n"}, distance.n, "so small that lcm(m, n) <= 2^62");
  }
  check_ties(distance, ties);
  if (distance.steps == 0) return 0;
  if (distance.steps > distance.m / common * distance.n) {
    return special::lowest_log();
  }
  const bool by_formula = distance.m == distance.n && ties.empty();
  const Lattice lattice(distance, ties);
  const double expected = log_limit(distance);
  if (!by_formula && expected > least_log_p && lattice.is_within(most_places)) {
    return special::clamp_log(log_lattice(lattice, expected));
  }
  if (distance.m == distance.n) {
    return special::clamp_log(log_equal_sizes(distance.steps, distance.n));
  }
  return expected;
}

// With grid points b_0 = 0 < … < b_K = gap:
//   P(A + B >= gap) <= sum_k P(b_k <= B < b_{k+1}) P(A >= gap - b_{k+1}) + P(B >= gap).
double log_two_suprema_bound(double gap, TwoSizes sizes) {
  if (gap <= 0) return 0;
  constexpr int cells = 2000;
  double total = log_massart(gap, sizes.n);
  for (int k = 0; k < cells; ++k) {
    const double low = gap * k / cells;
    const double high = gap * (k + 1) / cells;
    const double tail_low = log_massart(low, sizes.n);
    const double tail_high = log_massart(high, sizes.n);
    if (tail_high >= tail_low) continue;
    const double mass = tail_low + log_complement(tail_high - tail_low);
    total = log_sum(total, mass + log_massart(gap - high, sizes.m));
  }
  return special::clamp_log(total);
}

}  // namespace assay::stats
