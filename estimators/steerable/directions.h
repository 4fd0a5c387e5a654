#pragma once

// Directions with density in proportion to a sky times a steerable lobe.

#include <algorithm>
#include <memory>
#include <utility>

#include "sky/directions.h"
#include "steerable/lobe.h"
#include "steerable/sky_tree.h"

namespace assay::steerable {

using render::Vector3;

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
    sky::Direction result = in_triangle(node - tree_->count(), u, v);
    result.nodes = visited;
    return result;
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

 protected:
  sky::Direction in_triangle(std::size_t triangle, double u, double v) const {
    const TrianglePoint point = Warp{}(tree_->weights(triangle, a_), u, v);
    const auto [a, b, c] = tree_->sphere().corners(triangle);
    const Vector3 q = (1 - point.u - point.v) * a + point.u * b + point.v * c;
    return {frame_.to_local(normalised(q)), density_at(triangle, q, point)};
  }

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

}  // namespace assay::steerable
