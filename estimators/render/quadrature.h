#pragma once

// Tanh-sinh quadrature of several integrands at once, for references that sampling is held against.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

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

}  // namespace assay::render
