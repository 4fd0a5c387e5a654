// The integral of f(x) = e^(3x) over [0, 1] by weighted importance sampling: with g(x) =
// 5 (1 + x)^4 / 31, whose integral is 1, and x uniform, I^ = sum f(x_i) / sum g(x_i). A ratio of
// means: biased, consistent. n (E[I^] - I) -> I Var g - Cov(f, g) = -0.50012; n Var I^ ->
// Var(f - I g). The reference is I = (e^3 - 1) / 3, which the mean approaches as n grows.

#include "analytic/exponential.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

class Ratio final : public Estimator {
 public:
  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    double numerator = 0;
    double denominator = 0;
    for (std::uint64_t i = 0; i < primaries; ++i) {
      const double x = random.uniform();
      numerator += analytic::integrand(x);
      denominator += analytic::near_density(x);
    }
    out[0] = numerator / denominator;
    cost.samples += primaries;
  }
};

class RatioSetup final : public Setup {
 public:
  std::vector<Channel> channels() const override {
    // A ratio of sums lies between the extremes of f / g, at x = 1/3 and x = 1.
    return {{.mean = analytic::integral(),
             .low = analytic::integrand(1.0 / 3) / analytic::near_density(1.0 / 3),
             .high = analytic::integrand(1) / analytic::near_density(1)}};
  }
  std::unique_ptr<Estimator> make() const override { return std::make_unique<Ratio>(); }
};

}  // namespace

std::vector<Entry> analytic_ratio() {
  return {{{.name = "analytic/ratio",
            .summary = "The integral of e^(3x) over [0, 1] by weighted importance sampling.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by sum e^(3x) / sum g(x), g(x) = 5 "
                           "(1 + x)^4 / 31 of integral 1, x uniform. The bias times the number of "
                           "primaries tends to -0.50012.",
            .bias = BiasClass::inverse_primaries,
            .averages = false},
           [](Parameters&) { return std::make_shared<RatioSetup>(); }}};
}

}  // namespace assay::plugins
