#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace assay::stats {

struct Span {
  double low = 0;
  double high = 1;

  double middle() const { return (low + high) / 2; }
  double width() const { return high - low; }
  std::array<Span, 2> halves() const { return {{{low, middle()}, {middle(), high}}}; }
};

struct Integral {
  double value = 0;
  double error = 0;  // estimated, absolute
  double given = 0;  // the part of it that the function's values came with: no halving lessens it
};

inline Integral operator+(Integral a, Integral b) {
  return {a.value + b.value, a.error + b.error, a.given + b.given};
}

// A function of two variables at many places at once: value i is that at x[i] and y[i].
using PlaneValues = std::function<void(std::span<const double> x, std::span<const double> y,
                                       std::span<double> values)>;

// When an adaptive quadrature stops halving a part: its error is below the tolerance, it has been
// halved this often, or the evaluations of the whole computation are used up. What is left is in
// the error estimate.
struct QuadratureLimits {
  double tolerance = 1e-10;
  int deepest_bisection = 24;
  std::uint64_t evaluations = 20'000'000;
};

// Integrates functions of one variable, each value with an error of its own, part by part: 7-point
// Gauss-Legendre on a part against its two halves. Next to a jump the two may agree by luck, and
// one in the 2.5 % of a part beyond the outermost node is seen by neither. So what a jump may come
// to counts as error: how far the function at the ends of a part is from the polynomial through its
// nodes, which of a smooth one is next to nothing. Two jumps or a peak between nodes stay unseen.
// Densities are integrated so: a negative or non-finite value throws std::domain_error.
class AdaptiveQuadrature {
 public:
  static constexpr std::size_t nodes = 7;
  // Where a part is looked at: at the nodes, in the order of node_places(), and just inside its
  // ends.
  using Places = std::array<double, nodes + 2>;
  using Values = std::array<Integral, nodes + 2>;
  using Function = std::function<Values(const Places&)>;

  explicit AdaptiveQuadrature(QuadratureLimits limits) : limits_(limits) {}

  Integral over(const Function& function, Span span);
  // Part of a line of equal x.
  struct Line {
    double x;
    Span y;
  };
  // over() of a density along each line, the same numbers. Lines are halved side by side, a level
  // at a time, so that the density is asked for hundreds of places at once: of another process each
  // question takes longer than most densities. It throws as above.
  std::vector<Integral> along(const PlaneValues& density, std::span<const Line> lines);
  // Without halving: the integral and, as error, what the values' own errors and a jump may come
  // to.
  Integral once(const Function& function, Span span);
  // The same, and what it was made of: w_i f(x_i) times half the width at the nodes, in the order
  // of node_places(), and f at the ends, just inside.
  struct Sampled {
    Integral integral;
    std::array<double, nodes> parts = {};
    std::array<double, 2> ends = {};
  };
  // Share of a part that lies beyond the outermost node, on one side.
  static constexpr double blind_share = 0.0255;
  Sampled sampled(const Function& function, Span span);
  // The nodes in [-1, 1].
  static const std::array<double, nodes>& node_places();
  // A density as such a function, of one place or of as many as it is given: density(places,
  // values). Its values count against the limit; it throws as above.
  template <class Density>
  Function of(Density density) {
    return [this, density](const Places& at) {
      Places densities;
      if constexpr (std::is_invocable_v<Density, double>) {
        for (std::size_t i = 0; i < at.size(); ++i) densities[i] = density(at[i]);
      } else {
        density(std::span<const double>(at), std::span<double>(densities));
      }
      return counted(densities);
    };
  }
  bool exhausted() const { return used_ >= limits_.evaluations; }
  const QuadratureLimits& limits() const { return limits_; }
  // Of the densities counted since the last call of forget_largest().
  double largest() const { return largest_; }
  void forget_largest() { largest_ = 0; }

 private:
  struct Part;
  class Level;

  Values counted(std::span<const double, nodes + 2> densities);
  void halve(const PlaneValues& density, std::vector<Part>& parts, std::size_t first, bool ended);
  std::optional<std::vector<Integral>> side_by_side(const PlaneValues& density,
                                                    std::span<const Line> lines);
  Integral refined(const Function& function, Span span, Integral whole, int depth);

  QuadratureLimits limits_;
  std::uint64_t used_ = 0;
  double largest_ = 0;
};

// The parts that the borders of `panels` equal panels of `whole` cut `span` into.
std::vector<Span> cut(Span span, Span whole, std::size_t panels);

}  // namespace assay::stats
