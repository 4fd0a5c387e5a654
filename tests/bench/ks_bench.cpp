// Two-sample Kolmogorov-Smirnov of 2 x 10^7 values in all, against std::sort of the same data:
// sorting is what it should cost.

#include <algorithm>
#include <cstdio>
#include <vector>

#include "estimators/stream.h"
#include "stats/kolmogorov_smirnov.h"
#include "tests/bench/paired.h"

namespace {

using namespace assay;

constexpr std::size_t values_each = 10'000'000;

std::vector<double> uniforms(std::uint64_t observation) {
  Stream random(stream_key(1, "ks_bench", "", 0), observation);
  std::vector<double> values(values_each);
  for (double& value : values) value = random.uniform();
  return values;
}

}  // namespace

int main() {
  const std::vector<double> x = uniforms(0);
  const std::vector<double> y = uniforms(1);
  volatile double sink = 0;
  const auto sort_both = [&](std::vector<double>& a, std::vector<double>& b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
  };
  const auto test = [&] {
    std::vector<double> a = x;
    std::vector<double> b = y;
    sort_both(a, b);
    sink = stats::kolmogorov_smirnov(stats::ks_distance(a, b)).log_p_upper;
  };
  const auto sort = [&] {
    std::vector<double> a = x;
    std::vector<double> b = y;
    sort_both(a, b);
    sink = a[0] + b[0];
  };
  const bench::PairedTimes times = bench::time_in_pairs(test, sort, 7);
  std::printf(
      "two-sample KS of 2 x %zu values: %.2f s, sorting alone %.2f s, ratio %.3f (%.3f to "
      "%.3f)\n",
      values_each, times.first, times.second, times.ratio, times.least, times.most);
}
