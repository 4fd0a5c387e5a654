// Processor time of a boundary's constant, and of a p-value over looks, for times that grow by
// sqrt 2.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

#include "stats/planning/boundary.h"

int main() {
  constexpr int repetitions = 200;
  const auto microseconds = [](const auto& work) {
    const std::clock_t start = std::clock();
    for (int i = 0; i < repetitions; ++i) work();
    return 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / repetitions;
  };
  for (const int looks : {10, 16}) {
    std::vector<double> times;
    for (int k = 0; k < looks; ++k) times.push_back(std::exp2(k / 2.0));
    const assay::stats::WangTsiatis boundary(times);
    for (const double level : {0.01, 1e-9}) {
      volatile double constant = 0;
      volatile double crossing = 0;
      const double solved = microseconds([&] { constant = boundary.constant(level); });
      const double crossed = microseconds([&] { crossing = boundary.log_crossing(constant); });
      std::printf("%2d looks, level %g: constant %6.1f us, p-value %6.1f us\n", looks, level,
                  solved, crossed);
    }
  }
}
