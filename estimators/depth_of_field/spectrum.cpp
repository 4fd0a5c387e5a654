#include "depth_of_field/spectrum.h"

#include <algorithm>
#include <cmath>

#include "depth_of_field/exact.h"
#include "estimators/core/mapped.h"

namespace assay::depth_of_field {

Spectrum& Spectrum::travel(double distance) {
  for (Frequency& w : waves_) w.slope -= distance * w.position;
  return *this;
}

Spectrum& Spectrum::curve(double bend) {
  for (Frequency& w : waves_) w.position -= bend * w.slope;
  return *this;
}

Spectrum& Spectrum::reflect(double spread) {
  for (Frequency& w : waves_) {
    const double z = spread * w.slope;
    w.power *= std::exp(-z * z);
  }
  return *this;
}

Spectrum& Spectrum::occlude(std::span<const MaskWave> mask) {
  const std::vector<Frequency> before = waves_;
  for (const Frequency& w : before) {
    for (const MaskWave& m : mask) {
      const double power = w.power * m.power;
      waves_.push_back({w.position + m.frequency, w.slope, power});
      waves_.push_back({w.position - m.frequency, w.slope, power});
    }
  }
  return *this;
}

std::vector<CameraFrequency> Spectrum::at_camera(const Lens& lens) const {
  return mapped(waves_, [&](const Frequency& w) -> CameraFrequency {
    return {w.position + w.slope / lens.focus, -w.slope / lens.focus, w.power};
  });
}

double lens_variance(std::span<const CameraFrequency> waves, const Lens& lens) {
  double sum = 0;
  for (const CameraFrequency& w : waves) {
    const double j = disc_response(lens.radius * w.lens);
    sum += w.power * (1 - j * j);
  }
  return sum;
}

bool passes(const CameraFrequency& wave, const Lens& lens) {
  return wave.power > 0 && lens.radius * std::abs(wave.lens) < first_zero_of_disc_response;
}

double image_bandwidth(std::span<const CameraFrequency> waves, const Lens& lens) {
  double highest = 0;
  for (const CameraFrequency& w : waves) {
    if (passes(w, lens)) highest = std::max(highest, std::abs(w.image));
  }
  return highest;
}

}  // namespace assay::depth_of_field
