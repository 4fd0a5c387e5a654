#pragma once

#include <cstdint>
#include <limits>
#include <optional>
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

// The ends of a claimed and of a forbidden region of theta, by their distance from 0. A score
// against the claim is positive; a two-sided one is so on either side.
struct TestedRegions {
  double claimed = 0;
  std::optional<double> forbidden = {};
  bool two_sided = false;
};

// The scores at which a look fails a claim at alpha, or passes it at beta. Theta's estimate has
// this standard error, and theta is the drift.
StoppingLook stopping_look(const TestedRegions& regions, double error, double alpha, double beta);

// Probabilities of the verdicts, and the mean part of the last look that is drawn.
struct Outlook {
  double pass = 0;
  double fail = 0;
  double inconclusive = 0;
  double drawn = 1;
};
// One channel's at this theta. `sizes` are those of the looks.
Outlook outlook_at(std::span<const StoppingLook> looks, double theta,
                   std::span<const std::uint64_t> sizes);
// Several channels are counted as if never two of them failed together.
Outlook together(std::span<const Outlook> channels);

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
