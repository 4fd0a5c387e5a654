#include "stats/pyramids/image_welch_cells.h"

#include <algorithm>
#include <cmath>

namespace assay::stats {

void WelchCells::start(std::size_t cells) {
  for (std::vector<double>* each : {&mean, &m2, &effect, &variance, &reciprocal_degrees}) {
    each->assign(cells, 0.0);
  }
}

void WelchCells::finish_part(double count, double factor) {
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double part = factor * factor * m2[i] / (count * (count - 1));
    effect[i] += factor * mean[i];
    variance[i] += part;
    reciprocal_degrees[i] += part * part / (count - 1);
  }
  std::ranges::fill(mean, 0.0);
  std::ranges::fill(m2, 0.0);
}

StudentValue WelchCells::value(std::size_t cell) const {
  return {effect[cell] / std::sqrt(variance[cell]),
          variance[cell] * variance[cell] / reciprocal_degrees[cell]};
}

}  // namespace assay::stats
