#include "stats/basics/sorted.h"

#include <boost/sort/spreadsort/float_sort.hpp>

namespace assay::stats {

std::vector<double> sorted(std::vector<double> values) {
  boost::sort::spreadsort::float_sort(values.begin(), values.end());
  return values;
}

}  // namespace assay::stats
