#pragma once

#include <limits>
#include <span>
#include <vector>

namespace assay::stats {

// Scores at K interim analyses. The score z_k at information time t_k is normal with mean
// drift sqrt(t_k) and variance 1. Scores have independent increments:
//   Cov(z_j, z_k) = sqrt(t_j / t_k),   0 < t_1 < ... < t_K.
// Every estimate whose information grows has such scores asymptotically (Jennison & Turnbull 2000,
// ch. 3 and 11). A reference's own error only makes them depend more on each other.

// An analysis stops above, below, or between `from` and `to`. Else sampling goes on.
struct StoppingLook {
  double time = 1;
  double below = -std::numeric_limits<double>::infinity();
  double from = std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  double above = std::numeric_limits<double>::infinity();
};

struct StopProbabilities {
  double below = 0;
  double between = 0;
  double above = 0;
};

// P(sampling stops at analysis k on each side), by recursive numerical integration (Armitage,
// McPherson & Rowe 1969; Jennison & Turnbull 2000, ch. 19). The absolute error is below 1e-7. If
// only `above` stops, the relative error is below 1e-6. Throws std::domain_error: no analysis,
// times not positive or not ascending, bounds out of order or NaN, drift not finite.
std::vector<StopProbabilities> stop_probabilities(std::span<const StoppingLook> looks,
                                                  double drift = 0);

// Null hypothesis: drift <= 0. The test rejects where z_k >= C t_k^(delta - 1/2), times as parts of
// the last (Wang & Tsiatis 1987). Delta 0 is O'Brien & Fleming's boundary, 1/2 Pocock's.
class WangTsiatis {
 public:
  // Throws std::domain_error: no time, times not positive or not ascending, delta outside [0, 1/2].
  explicit WangTsiatis(std::span<const double> times, double delta = 0.25);

  // z_k = C shape_k.
  std::span<const double> shape() const { return shape_; }
  // ln P(some score crosses C shape | drift 0). Above C = 16 it is the union bound, which the last
  // analysis makes all of.
  double log_crossing(double constant) const;
  // The C that is crossed with probability `level`, accurate to 1e-6. Throws std::domain_error:
  // level outside (0, 1).
  double constant(double level) const;

 private:
  std::vector<double> times_;
  std::vector<double> shape_;
};

}  // namespace assay::stats
