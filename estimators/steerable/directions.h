#pragma once

// Directions with density in proportion to a sky times a steerable lobe.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "sky/directions.h"
#include "sky/octahedron.h"
#include "sky/radiance.h"
#include "sky/setting.h"
#include "steerable/triangle.h"

namespace assay::steerable {

using render::Vector3;

/// The first terms of cos+ = sum A_l Y_lm(n) Y_lm(w), with `offset` added to the coefficient of
/// Y_00. The number `coefficients` is 1, 4, 9 or 25: bands 0 to 0, 1, 2 or 4. Band 3 of the clamped
/// cosine is zero.
struct Lobe {
  std::size_t coefficients = 9;
  double offset = 0.15;
};

/// a such that the lobe about n is sum a_i Y_i(w); zero from `coefficients` on.
sky::Harmonics lobe_coefficients(const Lobe& lobe, const render::Vector3& n);

/// The lobe's value at the cosine c to its normal. By Legendre polynomials it is sum (2 l + 1) / (4
/// pi) A_l P_l(c) + offset / sqrt(4 pi).
double lobe_value(const Lobe& lobe, double c);

/// The least value of the lobe. With nine coefficients and no offset -19/480, at c = -8/15.
double lobe_minimum(const Lobe& lobe);

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

  sky::Octahedron sphere_;
  std::size_t coefficients_;
  double least_ = std::numeric_limits<double>::infinity();
  std::vector<double> vertices_;  // rows of luminance times harmonics
  std::vector<double> nodes_;
};

/// The factor |q|^3 / d from density per area to density per solid angle. The point q is on a plane
/// at the distance d from the origin.
struct PlaneToSphere {
  double operator()(const Vector3& q, double distance) const {
    const double r = length(q);
    return r * r * r / distance;
  }
};

/// Steerable importance sampling (Subr and Arvo 2007). The tree is descended with probabilities in
/// proportion to the children's weights; the number that chose is used again. Then comes a point q
/// of the triangle with its linear density, and w = q / |q|. The density is
///   p(w) = weight(q) / Z |q|^3 / d, Z the root's weight.
/// The type `Warp` maps the square to a triangle, `Measure` turns area into solid angle.
template <class Warp = LinearTriangle, class Measure = PlaneToSphere>
class SteeredDirections : public sky::Directions {
 public:
  /// The lobe, offset included, must be positive and so must the tree's least luminance.
  SteeredDirections(std::shared_ptr<const SkyTree> tree, const Lobe& lobe, render::Frame frame)
      : tree_(std::move(tree)),
        frame_(frame),
        a_(lobe_coefficients(lobe, frame.normal)),
        total_(tree_->node(1, a_)) {}

  Domain domain() const override { return Domain::sphere; }

  sky::Direction draw(double u, double v) const override {
    std::size_t node = 1;
    int visited = 0;
    while (node < tree_->count()) {
      ++visited;
      const double first = tree_->node(2 * node, a_);
      const double share = first / (first + tree_->node(2 * node + 1, a_));
      const bool left = u < share;
      u = left ? u / share : (u - share) / (1 - share);
      u = std::min(u, 1 - 0x1p-53);
      node = 2 * node + (left ? 0 : 1);
    }
    const std::size_t triangle = node - tree_->count();
    const TrianglePoint point = Warp{}(tree_->weights(triangle, a_), u, v);
    const auto [a, b, c] = tree_->sphere().corners(triangle);
    const Vector3 q = (1 - point.u - point.v) * a + point.u * b + point.v * c;
    return {frame_.to_local(normalised(q)), density_at(triangle, q, point), visited};
  }

  double density(const Vector3& local) const override {
    const Vector3 w = frame_.to_world(local);
    const std::size_t triangle = tree_->sphere().triangle(w);
    const auto [a, b, c] = tree_->sphere().corners(triangle);
    const double at_a = dot(w, cross(b, c));
    const double at_b = dot(w, cross(c, a));
    const double at_c = dot(w, cross(a, b));
    const double sum = at_a + at_b + at_c;
    const Vector3 q = (at_a / sum) * a + (at_b / sum) * b + (at_c / sum) * c;
    return density_at(triangle, q, {at_b / sum, at_c / sum});
  }

  Panels panels() const override {
    // A part is about as wide as a triangle, up to level 4; the marginals need no more.
    const std::size_t rows = std::size_t{4} << std::min<std::size_t>(tree_->sphere().level(), 3);
    return {.first = rows, .second = 2 * rows};
  }

  double total() const { return total_; }
  /// A bound of cos+ / density. Over each triangle the cosine is at most the greatest height of a
  /// vertex over the distance d of the plane. The weight is at least a vertex's, |q| at least d.
  double gain() const {
    double most = 0;
    for (std::size_t t = 0; t < tree_->count(); ++t) {
      const auto [a, b, c] = tree_->sphere().corners(t);
      const double distance = dot(normalised(cross(b - a, c - a)), a);
      const Vector3& n = frame_.normal;
      const double height = std::max({0.0, dot(n, a), dot(n, b), dot(n, c)});
      const VertexWeights w = tree_->weights(t, a_);
      const double least = std::min({w.a, w.b, w.c}) / total_ * distance * distance;
      most = std::max(most, std::min(1.0, height / distance) / least);
    }
    return most;
  }
  const SkyTree& tree() const { return *tree_; }
  const sky::Harmonics& steering() const { return a_; }
  const render::Frame& frame() const { return frame_; }

 private:
  double density_at(std::size_t triangle, const Vector3& q, const TrianglePoint& point) const {
    const auto [a, b, c] = tree_->sphere().corners(triangle);
    const double distance = dot(normalised(cross(b - a, c - a)), a);
    return point.weight(tree_->weights(triangle, a_)) / total_ * Measure{}(q, distance);
  }

  std::shared_ptr<const SkyTree> tree_;
  render::Frame frame_;
  sky::Harmonics a_;
  double total_;
};

/// Coefficients and offset. InputError at `offset` when the lobe is not positive everywhere: a
/// density that is zero or negative where light comes from makes the estimate biased.
Lobe read_lobe(Parameters&);

/// InputError at `floor` when the luminance is zero at a vertex of the subdivision: directions near
/// by might never be drawn.
std::shared_ptr<const SkyTree> read_tree(Parameters&, const sky::Setting&);

}  // namespace assay::steerable
