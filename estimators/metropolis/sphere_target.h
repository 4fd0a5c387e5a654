#pragma once

// Light transport to a row of receivers inside a sphere, by Embree's rays.

#include "metropolis/target.h"
#include "paths/family.h"

namespace assay::metropolis {

/// Pixel p is the wall between two heights of the unit sphere, one of `width` bands of equal area;
/// its element is the mean radiance that leaves the band, Le + a (mean Le) / (1 - mean a) averaged
/// over its area. A path starts at a uniform point of the wall (two coordinates), goes on with
/// probability `survival` at each vertex (one) in a cosine-distributed direction (two), and brings
/// what is emitted where it arrives: paths/plain in the coordinates' hands.
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
