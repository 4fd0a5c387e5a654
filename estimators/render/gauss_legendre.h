#pragma once

// Gauss-Legendre quadrature: nodes on an interval, and adaptively over triangles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <queue>
#include <utility>

#include "render/quadrature.h"
#include "render/vector.h"

namespace assay::render {

/// A node of a rule on [0, 1].
struct Node {
  double place;
  double weight;
};

/// The rule of N nodes on [0, 1], exact for polynomials of degree 2 N - 1: roots of the Legendre
/// polynomial by Newton's method.
template <std::size_t N>
std::array<Node, N> gauss_legendre() {
  std::array<Node, N> nodes{};
  for (std::size_t i = 0; i < N; ++i) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (N + 0.5));
    double slope = 0;
    for (int step = 0; step < 8; ++step) {
      double previous = 1;
      double value = x;
      for (std::size_t k = 2; k <= N; ++k) {
        const double degree = static_cast<double>(k);
        const double next = ((2 * degree - 1) * x * value - (degree - 1) * previous) / degree;
        previous = std::exchange(value, next);
      }
      slope = N * (x * value - previous) / (x * x - 1);
      x -= value / slope;
    }
    nodes[i] = {(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)};
  }
  return nodes;
}

using Corners = std::array<Vector3, 3>;

inline std::array<Corners, 4> quartered(const Corners& t) {
  const Vector3 ab = 0.5 * (t[0] + t[1]);
  const Vector3 bc = 0.5 * (t[1] + t[2]);
  const Vector3 ca = 0.5 * (t[2] + t[0]);
  return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

namespace detail {

/// N integrals over a triangle with respect to area by 8 x 8 nodes. Duffy's map takes the square to
/// the triangle; its area element is u.
template <std::size_t N, class F>
std::array<double, N> over_triangle(const F& f, const Corners& t) {
  static const auto nodes = gauss_legendre<8>();
  std::array<double, N> sum{};
  const double twice_area = length(cross(t[1] - t[0], t[2] - t[0]));
  for (const Node& u : nodes) {
    for (const Node& v : nodes) {
      const std::array<double, N> y = f(t[0] + u.place * ((t[1] - t[0]) + v.place * (t[2] - t[1])));
      const double weight = u.weight * v.weight * u.place * twice_area;
      for (std::size_t i = 0; i < N; ++i) sum[i] += weight * y[i];
    }
  }
  return sum;
}

/// A triangle with its integrals, the change that its last refinement made, and how much that is
/// of the whole.
template <std::size_t N>
struct Patch {
  Corners corners;
  Integrals<N> integrals;
  double urgency = 0;

  bool operator<(const Patch& other) const { return urgency < other.urgency; }
};

}  // namespace detail

/// The integrals over triangles, with respect to area, of the N components of f, none negative.
///
/// Triangles are quartered, first those whose refinement changed some integral the most. It ends
/// when the last changes are below `tolerance` of every integral's scale, or there are `most`
/// triangles. The sums of these changes are the errors. The scale of an integral is the sum of
/// those of its group. Changes are no bound: a lobe between the nodes of the given triangles makes
/// none.
template <std::size_t N, class F>
class TriangleQuadrature {
 public:
  struct Plan {
    double tolerance = 1e-12;
    std::size_t most = 10000;
    std::array<std::size_t, N> group{};
  };

  TriangleQuadrature(F f, const Plan& plan) : f_(std::move(f)), plan_(plan) {}

  void add(const Corners& triangle) {
    push({triangle, {detail::over_triangle<N>(f_, triangle), {}}, 0});
  }

  Integrals<N> refined() {
    refine_all_once();
    while (patches_.size() < plan_.most && !settled()) {
      const Patch patch = patches_.top();
      patches_.pop();
      split(patch);
    }
    return total_;
  }

 private:
  using Patch = detail::Patch<N>;

  double scale(std::size_t i) const {
    double sum = 0;
    for (std::size_t k = 0; k < N; ++k) {
      if (plan_.group[k] == plan_.group[i]) sum += total_.value[k];
    }
    return sum;
  }

  void push(Patch patch) {
    total_ += patch.integrals;
    for (std::size_t i = 0; i < N; ++i) {
      const double whole = scale(i);
      if (whole > 0) patch.urgency = std::max(patch.urgency, patch.integrals.error[i] / whole);
    }
    patches_.push(std::move(patch));
  }

  // The change that quartering makes is shared by the four.
  void split(const Patch& patch) {
    std::array<Patch, 4> parts;
    const auto corners = quartered(patch.corners);
    std::array<double, N> change{};
    for (std::size_t k = 0; k < 4; ++k) {
      parts[k] = {corners[k], {detail::over_triangle<N>(f_, corners[k]), {}}, 0};
      for (std::size_t i = 0; i < N; ++i) change[i] += parts[k].integrals.value[i];
    }
    for (std::size_t i = 0; i < N; ++i) {
      change[i] = std::abs(change[i] - patch.integrals.value[i]);
      total_.value[i] -= patch.integrals.value[i];
      total_.error[i] -= patch.integrals.error[i];
    }
    for (Patch& part : parts) {
      for (std::size_t i = 0; i < N; ++i) part.integrals.error[i] = change[i] / 4;
      push(part);
    }
  }

  void refine_all_once() {
    std::priority_queue<Patch> coarse;
    std::swap(coarse, patches_);
    for (; !coarse.empty(); coarse.pop()) split(coarse.top());
  }

  bool settled() const {
    for (std::size_t i = 0; i < N; ++i) {
      if (total_.error[i] > plan_.tolerance * scale(i)) return false;
    }
    return true;
  }

  F f_;
  Plan plan_;
  Integrals<N> total_;
  std::priority_queue<Patch> patches_;
};

}  // namespace assay::render
