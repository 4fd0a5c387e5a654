#include "stats/tails/smirnov.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/kolmogorov.h"
#include "stats/tails/special.h"

namespace assay::stats {
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
