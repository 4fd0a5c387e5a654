#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
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
  double error = 0;  // Estimated, absolute.
  // Part of the error that came with the function's values. Halving does not lessen it.
  double given = 0;
};

inline Integral operator+(Integral a, Integral b) {
  return {a.value + b.value, a.error + b.error, a.given + b.given};
}

// A function of two variables at many places at once. Value i belongs to (x[i], y[i]).
using PlaneValues = std::function<void(std::span<const double> x, std::span<const double> y,
                                       std::span<double> values)>;

// An adaptive quadrature halves a part until one of these holds. The part's error is below the
// tolerance, it was halved `deepest_bisection` times, or all evaluations are used up. The error
// estimate covers what is left.
inline constexpr int deepest_bisection = 24;
struct QuadratureLimits {
  double tolerance = 1e-10;
  std::uint64_t evaluations = 20'000'000;
};

// Integrates functions of one variable, part by part. Each value has an error of its own. The rule
// compares 7-point Gauss-Legendre on a part with the same on its two halves. Next to a jump the two
// may agree by luck, and neither sees the 2.5 % of a part beyond the outermost node. So the error
// also covers what a jump may come to. That is the distance at a part's ends between the function
// and the polynomial through its nodes. A peak, or two jumps, between nodes stay unseen. The class
// integrates densities: a negative or non-finite value throws std::domain_error.
class AdaptiveQuadrature {
 public:
  static constexpr std::size_t nodes = 7;
  // A part is looked at at the nodes, and then just inside its ends.
  using Places = std::array<double, nodes + 2>;
  using Values = std::array<Integral, nodes + 2>;
  using Function = std::function<Values(const Places&)>;

  explicit AdaptiveQuadrature(QuadratureLimits limits) : limits_(limits) {}

  Integral over(const Function& function, Span span);
  struct Line {
    double x;
    Span y;
  };
  // The same numbers as over() along each line. Lines are halved side by side, a level at a time,
  // so that each call asks for hundreds of places. A density in another process is slow per call.
  // Throws as above.
  std::vector<Integral> along(const PlaneValues& density, std::span<const Line> lines);
  // The integral without halving. Its error covers the values' own errors and a jump. Its parts are
  // w_i f(x_i) times half the width at each node, in their order. Just inside its ends f departs
  // from the polynomial by so much, both added.
  struct Sampled {
    Integral integral;
    std::array<double, nodes> parts = {};
    double departure_at_ends = 0;
  };
  Sampled sampled(const Function& function, Span span);
  // A density as such a function, called as density(place) or density(places, values). Its values
  // count against the limit. Throws as above.
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
  // Largest density since the last call of forget_largest().
  double largest() const { return largest_; }
  void forget_largest() { largest_ = 0; }

 private:
  using Wholes = std::function<std::vector<Integral>(std::span<const Line>)>;

  Values counted(std::span<const double, nodes + 2> densities);
  std::vector<Integral> whole(const PlaneValues& density, std::span<const Line> lines);
  std::vector<Integral> refined(const Wholes& whole, std::span<const Line> lines);

  QuadratureLimits limits_;
  std::uint64_t used_ = 0;
  double largest_ = 0;
};

// Panels tell where a quadrature looks closely. They have equal borders, and borders of their own.
struct Panelling {
  std::size_t equal = 1;
  std::vector<double> borders = {};  // Ascending.
};

// The parts that the borders of the panels of `whole` cut `span` into.
std::vector<Span> cut(Span span, Span whole, const Panelling& panels);

// Borders that show the peaks of a law to a quadrature, from values drawn of it, the densest first.
// They are 33 of its quantiles, as far as neighbours are closer than 1 / 1024 of `whole`. A peak of
// few values stands out among those of like density: each of 32 strata of more than 32 values has
// such quantiles, too. They count if both neighbours are closer than 1 / 2048, and no border is
// within 16 times that distance. A peak shows with some twelve of 4096 values. From the borders on
// gaps double, so that no part is more than twice as long as its neighbour toward a peak. None for
// an even law.
std::vector<double> borders_of_peaks(std::span<const double> values, Span whole);

// The distribution function of a density as a table. Between two places it is the integral of the
// polynomial through the density at the rule's nodes there.
struct TabulatedLaw {
  // Legendre coefficients. The integral of the interpolant up to t in [-1, 1] is
  //  `mass / 2 (t + 1) + sum over k >= 1 of slope_(k-1) (P_(k+1)(t) - P_(k-1)(t))`.
  using Slopes = std::array<double, AdaptiveQuadrature::nodes - 1>;

  std::vector<double> place;      // Ascending.
  std::vector<double> cumulated;  // Mass up to each place, the first 0.
  std::vector<Slopes> slopes;     // Slopes of each part, times the mass.
  double total_error = 0;         // Estimated error of the mass.
  // Estimate of sup |table - law|: the largest departure plus the errors of all masses, over the
  // mass. A part's departure compares the law from its own nodes with that from its halves' nodes,
  // at seven places inside. It adds what a jump beyond the outermost nodes may hide. It is at least
  // a quarter of the departure of the part that it is a half of. The table has the halves, which
  // are nearer: by 2^-7 where the density is smooth, by about 1/2 where it jumps.
  double error = 0;

  double total() const { return cumulated.back(); }
  // P(X <= x | a point): 0 below the first place, 1 above the last.
  double operator()(double x) const;
};

// Halves parts where the mass is and where the density is no polynomial, level by level. The
// visible part of their error is then below 1e-6. `parts` are contiguous and ascending. It stops
// when the rule's evaluations are used up. Throws std::domain_error when there is no mass, or a
// density is negative or not finite.
TabulatedLaw tabulate(const AdaptiveQuadrature::Function& density, const std::vector<Span>& parts,
                      AdaptiveQuadrature& rule);

}  // namespace assay::stats
