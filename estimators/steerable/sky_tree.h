#pragma once

// A sky times spherical harmonics, summed up over a tree of triangles: for any normal, weights of
// all nodes are one scalar product away.

#include <cstddef>
#include <vector>

#include "sky/harmonics.h"
#include "sky/octahedron.h"
#include "sky/radiance.h"
#include "steerable/linear_triangle.h"

namespace assay::steerable {

/// How a sky is cut up.
struct Preparation {
  std::size_t level = 4;         ///< of the octahedron's subdivision: 8 4^level triangles
  std::size_t coefficients = 9;  ///< harmonics kept
  double floor = 0;  ///< added to the luminance at every vertex, as a part of the sky's mean
};

/// Nodes are numbered as in a heap. The root is 1, and the children of k are 2 k and 2 k + 1.
/// Leaves are `count` to 2 count - 1.
class SkyTree {
 public:
  SkyTree(const sky::Radiance& radiance, const Preparation& preparation);

  const sky::Octahedron& sphere() const { return sphere_; }
  /// Triangles; a power of two.
  std::size_t count() const { return sphere_.triangles().size(); }
  std::size_t coefficients() const { return coefficients_; }
  /// The least luminance, floor included, at a vertex.
  double least() const { return least_; }

  /// The area times the mean of the three vertices' weights, summed over the leaves below: for
  /// steering coefficients a.
  double node(std::size_t index, const sky::Harmonics& a) const {
    return product(nodes_, index, a);
  }
  VertexWeights weights(std::size_t triangle, const sky::Harmonics& a) const {
    const auto& [x, y, z] = sphere_.triangles()[triangle];
    return {product(vertices_, x, a), product(vertices_, y, a), product(vertices_, z, a)};
  }

 private:
  double product(const std::vector<double>& table, std::size_t row, const sky::Harmonics& a) const {
    const double* values = &table[row * coefficients_];
    double sum = 0;
    for (std::size_t i = 0; i < coefficients_; ++i) sum += a[i] * values[i];
    return sum;
  }
  void fill_vertices(const sky::Radiance& radiance, double floor);
  void fill_nodes();

  sky::Octahedron sphere_;
  std::size_t coefficients_;
  double least_ = 0;
  std::vector<double> vertices_;  // rows of luminance times harmonics
  std::vector<double> nodes_;
};

}  // namespace assay::steerable
