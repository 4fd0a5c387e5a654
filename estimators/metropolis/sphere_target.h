#pragma once

// Light transport to a row of receivers inside a sphere, by Embree's rays.

#include "metropolis/target.h"
#include "paths/family.h"

namespace assay::metropolis {

/// Pixel p is the wall between two heights of the unit sphere, one of `width` bands of equal area.
/// Its element is the mean radiance that leaves the band, Le + a (mean Le) / (1 - mean a) averaged
/// over its area. A path is that of paths/plain. It starts at a uniform point of the wall (two
/// coordinates). At each vertex it goes on with probability `survival` (one coordinate) in a
/// cosine-distributed direction (two). It brings what is emitted where it arrives.
class SphereTarget final : public Target {
 public:
  struct Form {
    paths::SphereScene scene;
    bool grey;
    std::size_t width;
    double survival;
  };
  explicit SphereTarget(Form form);

  ImageShape shape() const override;
  Contribution at(Coordinates& point, Cost& cost) const override;
  std::vector<double> means() const override;

 private:
  Form form_;
  paths::SharedSphere world_;
};

}  // namespace assay::metropolis
