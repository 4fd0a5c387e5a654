#pragma once

// From data to positions on a chart.

#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

struct Range {
  double low = 0;
  double high = 0;
};

/// Gathers the finite numbers that a chart must show.
class Extent {
 public:
  void include(double value);
  void include(Number value);
  bool empty() const { return empty_; }
  /// Widened where it is a point, or too narrow or too wide for arithmetic with doubles.
  Range range() const;
  /// range() with `fraction` of its width added at both ends.
  Range padded(double fraction) const;

 private:
  Range range_;
  bool empty_ = true;
};

struct Tick {
  double value;
  std::string label;
};

/// A linear or logarithmic axis: a domain of data mapped onto pixels.
class Scale {
 public:
  enum class Kind { linear, logarithmic };
  struct Definition {
    Range domain;  ///< low < high; above zero where logarithmic
    Range pixels;
    Kind kind = Kind::linear;
  };

  explicit Scale(Definition definition) : d_(definition) {}

  /// Position in pixels; what lies outside the domain is moved to its end.
  double operator()(double value) const;

  /// About `wanted` round numbers inside the domain: multiples of 1, 2 or 5 times a power of ten;
  /// powers of ten on a logarithmic axis.
  std::vector<Tick> ticks(int wanted) const;

  const Definition& definition() const { return d_; }

 private:
  std::vector<Tick> linear_ticks(int wanted) const;
  std::vector<Tick> logarithmic_ticks(int wanted) const;
  std::vector<Tick> short_logarithmic_ticks(int wanted) const;

  Definition d_;
};

/// An axis label: as many decimals as `step` needs, powers of ten as 2e6.
std::string axis_label(double value, double step);

}  // namespace assay::reports
