#pragma once

// Tanh-sinh quadrature of several integrands at once, for references that sampling is held against.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <queue>
#include <span>
#include <utility>

#include "render/vector.h"

namespace assay::render {

template <std::size_t N>
struct Integrals {
  std::array<double, N> value{};
  std::array<double, N> error{};  ///< the last change of the value, which bounds what is left

  Integrals& operator+=(const Integrals& other) {
    for (std::size_t i = 0; i < N; ++i) {
      value[i] += other.value[i];
      error[i] += other.error[i];
    }
    return *this;
  }
};

namespace detail {

// Adds the trapezoidal nodes t = first, first + step, ... of both signs.
template <std::size_t N, class F>
void add_nodes(std::array<double, N>& sum, const F& f, std::array<double, 2> range,
               std::array<double, 2> nodes) {
  const double half = (range[1] - range[0]) / 2;
  // Beyond |t| = 3.5 the weights are below 1e-21.
  for (double t = nodes[0]; t <= 3.5; t += nodes[1]) {
    const double q = std::exp(-std::numbers::pi * std::sinh(t));
    const double from_end = half * 2 * q / (1 + q);
    const double weight = half * std::numbers::pi / 2 * std::cosh(t) * 4 * q / ((1 + q) * (1 + q));
    for (const double x : {range[0] + from_end, range[1] - from_end}) {
      // A node that rounds to an end is where a singular integrand has no value.
      if (x <= range[0] || x >= range[1]) continue;
      const std::array<double, N> y = f(x);
      for (std::size_t i = 0; i < N; ++i) sum[i] += weight * y[i];
      if (t == 0) break;  // both nodes are the middle
    }
  }
}

}  // namespace detail

/// The integrals over [range[0], range[1]] of the N components of f, by the tanh-sinh rule
/// (Takahasi & Mori 1974). The step is halved at most nine times, until no component changes by
/// more than `tolerance` times its value. Integrands must be analytic inside. Integrable
/// singularities at the ends are harmless.
template <std::size_t N, class F>
Integrals<N> tanh_sinh(const F& f, std::array<double, 2> range, double tolerance) {
  std::array<double, N> sum{};
  detail::add_nodes(sum, f, range, {0, 0.5});
  Integrals<N> result;
  for (std::size_t i = 0; i < N; ++i) result.value[i] = 0.5 * sum[i];
  double step = 0.5;
  for (int level = 0; level < 9; ++level) {
    detail::add_nodes(sum, f, range, {step / 2, step});
    step /= 2;
    bool settled = true;
    for (std::size_t i = 0; i < N; ++i) {
      const double value = step * sum[i];
      result.error[i] = std::abs(value - result.value[i]);
      settled = settled && result.error[i] <= tolerance * std::abs(value);
      result.value[i] = value;
    }
    if (settled) break;
  }
  return result;
}

/// The same over the pieces between `breaks` (sorted here), where integrands may have kinks.
template <std::size_t N, class F>
Integrals<N> tanh_sinh_pieces(const F& f, std::span<double> breaks, double tolerance) {
  std::sort(breaks.begin(), breaks.end());
  Integrals<N> total;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    if (breaks[i] == breaks[i + 1]) continue;
    total += tanh_sinh<N>(f, {breaks[i], breaks[i + 1]}, tolerance);
  }
  return total;
}

// Gauss-Legendre quadrature: nodes on an interval, and adaptively over triangles.

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
