#pragma once

#include "stats/basics/moments.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::tests {

// The laws on which every test of a mean is calibrated.
struct Law {
  const char* name;
  double mean;
  double (*draw)(Philox&);
};

namespace laws {

inline const Law normal{"normal", 0, [](Philox& r) { return r.normal(); }};
inline const Law exponential{"exponential", 1, [](Philox& r) { return r.exponential(); }};
inline const Law lognormal_half{"lognormal(0.5)", std::exp(.125),
                                [](Philox& r) { return std::exp(.5 * r.normal()); }};
inline const Law lognormal_one{"lognormal(1)", std::exp(.5),
                               [](Philox& r) { return std::exp(r.normal()); }};
inline const Law bernoulli{"Bernoulli(.01)", .01,
                           [](Philox& r) { return r.uniform() < .01 ? 1.0 : 0.0; }};
inline const Law uniform{"uniform", .5, [](Philox& r) { return r.uniform(); }};
// Four of five values are zero.
inline const Law zero_inflated{"zero-inflated", .2,
                               [](Philox& r) { return r.uniform() < .2 ? r.exponential() : 0.0; }};
inline const Law zero_inflated_uniform{
    "zero-inflated uniform", .1, [](Philox& r) { return r.uniform() < .2 ? r.uniform() : 0.0; }};
inline const Law t5{"t5", 0, [](Philox& r) {
                      double sum = 0;
                      for (int i = 0; i < 5; ++i) {
                        const double z = r.normal();
                        sum += z * z;
                      }
                      return r.normal() / std::sqrt(sum / 5);
                    }};

}  // namespace laws

inline std::vector<double> draw_values(const Law& law, std::size_t n, Philox& random) {
  std::vector<double> values(n);
  for (double& value : values) value = law.draw(random);
  return values;
}

inline stats::Moments draw_moments(const Law& law, std::size_t n, Philox& random) {
  stats::Moments moments;
  for (std::size_t i = 0; i < n; ++i) moments.add(law.draw(random));
  return moments;
}

}  // namespace assay::tests
