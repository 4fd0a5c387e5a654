#pragma once

// Times two pieces of work in turn, A B B A A B …, so that a drift of the machine favours none. The
// answer is the median of the ratios of neighbours.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace assay::bench {

template <class Work>
double seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct PairedTimes {
  double ratio;          ///< median of first / second
  double least, most;    ///< of the ratios
  double first, second;  ///< medians in seconds
};

template <class First, class Second>
PairedTimes time_in_pairs(First&& first, Second&& second, std::size_t pairs) {
  std::vector<double> ratios, a, b;
  first();
  second();
  for (std::size_t i = 0; i < pairs; ++i) {
    double one = 0;
    double other = 0;
    if (i % 2 == 0) {
      one = seconds(first);
      other = seconds(second);
    } else {
      other = seconds(second);
      one = seconds(first);
    }
    a.push_back(one);
    b.push_back(other);
    ratios.push_back(one / other);
  }
  return {median(ratios), *std::min_element(ratios.begin(), ratios.end()),
          *std::max_element(ratios.begin(), ratios.end()), median(a), median(b)};
}

}  // namespace assay::bench
