#include "stats/pyramids/image_welch_cells.h"

#include <algorithm>

namespace assay::stats {

void WelchCells::start(std::size_t cells) {
  for (std::vector<double>* each :
       {&mean, &m2, &effect, &variance[0], &variance[1], &reciprocal_degrees}) {
    each->assign(cells, 0.0);
  }
  halves_that_vary.assign(cells, 0);
}

void WelchCells::finish_part(std::size_t half, std::size_t side, double count, double factor) {
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double part = factor * factor * m2[i] / (count * (count - 1));
    effect[i] += factor * mean[i];
    variance[side][i] += part;
    if (part > 0) halves_that_vary[i] |= static_cast<unsigned char>(1U << half);
    reciprocal_degrees[i] += part * part / (count - 1);
  }
  std::ranges::fill(mean, 0.0);
  std::ranges::fill(m2, 0.0);
}

void WelchCells::put(std::size_t cell, CellNoise& noise) const {
  noise.effect = effect[cell];
  noise.variance = {variance[0][cell], variance[1][cell]};
  const double total = noise.variance[0] + noise.variance[1];
  noise.degrees = total * total / reciprocal_degrees[cell];
}

}  // namespace assay::stats
