#pragma once

// The parts of the estimator and the samplers of points of a triangle with linear density.

#include <memory>
#include <vector>

#include "estimators/estimator.h"
#include "steerable/linear_triangle.h"

namespace assay::steerable {

/// `weights`: [w_a, w_b, w_c].
std::vector<ParameterInformation> triangle_parameters();
/// InputError at `weights` unless they are three numbers, none negative, of positive sum.
VertexWeights read_weights(Parameters&);
/// The coordinates a, b, c; mean, and variance too if the estimator is the sound one.
std::vector<Channel> triangle_channels(const VertexWeights&, bool with_variance);

/// Points as a sampler: density 6 weight / sum.
template <class Warp>
class TrianglePointSampler final : public Sampler {
 public:
  explicit TrianglePointSampler(const VertexWeights& weights) : weights_(weights) {}

  Domain domain() const override { return Domain::triangle; }
  SamplerDraw sample(Stream& random) const override {
    const double x = random.uniform();
    const auto [u, v] = Warp{}(weights_, x, random.uniform());
    const Point point = {u, v, 0};
    return {.point = point, .density = density(point), .weight = 1};
  }
  double density(const Point& p) const override {
    return 6 * TrianglePoint{p[0], p[1]}.weight(weights_) / weights_.sum();
  }
  double evaluate(const Point& p) const override { return density(p); }

 private:
  VertexWeights weights_;
};

/// The pair of numbers behind a point: constant density 1.
template <class Warp>
class TriangleSquareSampler final : public Sampler {
 public:
  explicit TriangleSquareSampler(const VertexWeights& weights) : weights_(weights) {}

  Domain domain() const override { return Domain::square; }
  SamplerDraw sample(Stream& random) const override {
    const double x = random.uniform();
    const SquarePoint square = square_of(weights_, Warp{}(weights_, x, random.uniform()));
    return {.point = {square.x, square.y, 0}, .density = 1, .weight = 1};
  }
  double density(const Point&) const override { return 1; }
  double evaluate(const Point&) const override { return 1; }

 private:
  VertexWeights weights_;
};

template <class Warp>
class TriangleEstimator final : public Estimator {
 public:
  explicit TriangleEstimator(const VertexWeights& weights) : weights_(weights) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    double sum_u = 0;
    double sum_v = 0;
    for (std::uint64_t i = 0; i < primaries; ++i) {
      const double x = random.uniform();
      const auto [u, v] = Warp{}(weights_, x, random.uniform());
      sum_u += u;
      sum_v += v;
    }
    const auto n = static_cast<double>(primaries);
    out[0] = 1 - (sum_u + sum_v) / n;
    out[1] = sum_u / n;
    out[2] = sum_v / n;
    cost.samples += primaries;
  }

 private:
  VertexWeights weights_;
};

template <class Warp>
std::shared_ptr<const Setup> triangle_setup(const VertexWeights& weights, bool sound) {
  return setup_of(
      {.channels = triangle_channels(weights, sound),
       .make = [weights] { return std::make_unique<TriangleEstimator<Warp>>(weights); },
       .samplers = {{"point", std::make_shared<TrianglePointSampler<Warp>>(weights)},
                    {"square", std::make_shared<TriangleSquareSampler<Warp>>(weights)}}});
}

}  // namespace assay::steerable
