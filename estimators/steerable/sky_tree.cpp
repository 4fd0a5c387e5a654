#include "steerable/sky_tree.h"

#include <algorithm>
#include <limits>

namespace assay::steerable {

SkyTree::SkyTree(const sky::Radiance& radiance, const Preparation& preparation)
    : sphere_(preparation.level), coefficients_(preparation.coefficients) {
  const sky::Rgb mean = radiance.mean();
  const double grey = radiance.colours() == 1 ? mean[0] : (mean[0] + mean[1] + mean[2]) / 3;
  fill_vertices(radiance, preparation.floor * grey);
  fill_nodes();
}

void SkyTree::fill_vertices(const sky::Radiance& radiance, double floor) {
  least_ = std::numeric_limits<double>::infinity();
  for (const sky::Vector3& w : sphere_.vertices()) {
    const double value = luminance(radiance, w) + floor;
    least_ = std::min(least_, value);
    const sky::Harmonics y = sky::harmonics(w);
    for (std::size_t i = 0; i < coefficients_; ++i) vertices_.push_back(value * y[i]);
  }
}

void SkyTree::fill_nodes() {
  nodes_.resize(2 * count() * coefficients_);
  for (std::size_t t = 0; t < count(); ++t) {
    const auto [a, b, c] = sphere_.corners(t);
    const double third_of_area = length(cross(b - a, c - a)) / 6;
    for (const std::uint32_t vertex : sphere_.triangles()[t]) {
      for (std::size_t i = 0; i < coefficients_; ++i) {
        nodes_[(count() + t) * coefficients_ + i] +=
            third_of_area * vertices_[vertex * coefficients_ + i];
      }
    }
  }
  for (std::size_t node = count() - 1; node > 0; --node) {
    for (std::size_t i = 0; i < coefficients_; ++i) {
      nodes_[node * coefficients_ + i] =
          nodes_[2 * node * coefficients_ + i] + nodes_[(2 * node + 1) * coefficients_ + i];
    }
  }
}

}  // namespace assay::steerable
