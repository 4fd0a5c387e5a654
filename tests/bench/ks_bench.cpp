// Two-sample Kolmogorov-Smirnov of 2 x 10^7 values in all, against std::sort of the same data:
// sorting is what it should cost. And of 10^4 against 10^4, sorted and with the exact p-value.

#include <algorithm>
#include <cstdio>
#include <vector>

#include "estimators/stream.h"
#include "stats/laws/kolmogorov_smirnov.h"
#include "tests/bench/paired.h"

namespace {

using namespace assay;

constexpr std::size_t values_each = 10'000'000;

std::vector<double> uniforms(std::uint64_t observation, std::size_t count = values_each) {
  Stream random(stream_key(1, "ks_bench", "", 0), observation);
  std::vector<double> values(count);
  for (double& value : values) value = random.uniform();
  return values;
}

/// Sorts copies of both and tests them.
double sorted_and_tested(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return stats::kolmogorov_smirnov(stats::ks_distance(a, b)).log_p_upper;
}

void report_small() {
  constexpr std::size_t count = 10'000;
  const std::vector<double> x = uniforms(2, count);
  const std::vector<double> y = uniforms(3, count);
  std::vector<double> times;
  volatile double sink = 0;
  for (int i = 0; i < 21; ++i) {
    times.push_back(bench::seconds([&] { sink = sorted_and_tested(x, y); }));
  }
  std::printf("two-sample KS of 2 x %zu values, sorted, exact p: %.2f ms, median of %zu; ln p %g\n",
              count, 1e3 * bench::median(times), times.size(), double{sink});
}

}  // namespace

int main() {
  report_small();
  const std::vector<double> x = uniforms(0);
  const std::vector<double> y = uniforms(1);
  volatile double sink = 0;
  const auto test = [&] { sink = sorted_and_tested(x, y); };
  const auto sort = [&] {
    std::vector<double> a = x;
    std::vector<double> b = y;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    sink = a[0] + b[0];
  };
  const bench::PairedTimes times = bench::time_in_pairs(test, sort, 7);
  std::printf(
      "two-sample KS of 2 x %zu values: %.2f s, sorting alone %.2f s, ratio %.3f (%.3f to "
      "%.3f)\n",
      values_each, times.first, times.second, times.ratio, times.least, times.most);
}
