#pragma once

#include <cstddef>
#include <vector>

#include "stats/images/image_family.h"
#include "stats/pyramids/image_noise.h"
#include "stats/tails/t_to_z.h"

namespace assay::stats {

// Internal to image_pyramid: a cell whose neighbours are not known yet. finding.z is its own.
struct Candidate {
  ImageFinding finding;
  CellNoise noise;
};

// The cells of one group in a tile that are farthest from zero by their own noise. It counts the
// cells that they were chosen from.
class Candidates {
 public:
  // Counts a cell with this value. True if it may be one of those that are kept.
  bool wants(StudentValue value);
  // finding.z must be set.
  void keep(const Candidate& candidate);
  const std::vector<Candidate>& kept() const { return kept_; }
  double windows() const { return windows_; }

 private:
  static constexpr std::size_t most = 4;
  std::vector<Candidate> kept_;
  double windows_ = 0;
};

// The cell of a group that is farthest from zero once its neighbours are heard, so far. Among
// equals the first by channel, row and column wins, in whichever order they come.
struct BestCell {
  ImageFinding finding;
  StudentValue value{.t = 0, .degrees = 0};  // degrees 0: none yet.
  double windows = 0;
};
// False if a cell cannot beat it by its own noise. Neighbours only take away.
bool beats(const ImageFinding& finding, const BestCell& best);
void offer(BestCell& best, const Candidate& candidate, const NoisePyramid& noise);

// The value that a cell's own noise gives.
StudentValue own_value(const CellNoise& noise);

}  // namespace assay::stats
