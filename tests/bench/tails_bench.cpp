// A million p-values of Student's t, chi-square and F, both tails in logarithms, one thread. The
// same arguments as tests/bench/tails_scipy.py, which times scipy's functions.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <vector>

#include "stats/tails/tails.h"
#include "tests/bench/paired.h"

namespace {

using namespace assay;

constexpr std::uint64_t count = 1'000'000;
constexpr std::size_t repetitions = 7;

// The fractional parts of multiples of irrational numbers: evenly spread, alike in every language.
double spread(std::uint64_t i, double irrational) {
  const double value = static_cast<double>(i + 1) * irrational;
  return value - static_cast<double>(static_cast<std::uint64_t>(value));
}

constexpr double golden = 0.6180339887498949;
constexpr double silver = 0.41421356237309503;

/// Degrees of freedom from 5 to 2000, alike in every decade.
double degrees(std::uint64_t i) { return 5 * std::pow(400.0, spread(i, silver)); }

// Processor time, so that other work on the machine does not count.
template <class Work>
double processor_seconds(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

template <class Tails>
void report(const char* name, const Tails& tails) {
  std::vector<double> times;
  volatile double sink = 0;
  for (std::size_t r = 0; r < repetitions; ++r) {
    times.push_back(processor_seconds([&] {
      double sum = 0;
      for (std::uint64_t i = 0; i < count; ++i) sum += tails(i).upper;
      sink = sum;
    }));
  }
  const double best = *std::min_element(times.begin(), times.end());
  std::printf("%-12s %7.1f ns a p-value, median; %7.1f best; sum of ln p %.9g\n", name,
              1e9 * bench::median(times) / count, 1e9 * best / count, double{sink});
}

}  // namespace

int main() {
  std::vector<double> nu(count), t(count), chi(count), f(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    nu[i] = degrees(i);
    t[i] = 10 * spread(i, golden) - 5;
    // From a half to twice the mean, and F likewise.
    chi[i] = nu[i] * (0.5 + 1.5 * spread(i, golden));
    f[i] = 0.5 + 1.5 * spread(i, golden);
  }
  report("t", [&](std::uint64_t i) { return stats::student_t_tails(t[i], nu[i]); });
  report("chi-square", [&](std::uint64_t i) { return stats::chi_square_tails(chi[i], nu[i]); });
  report("F", [&](std::uint64_t i) {
    return stats::f_tails(f[i], {.numerator = nu[i], .denominator = nu[count - 1 - i]});
  });
}
