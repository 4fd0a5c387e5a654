#pragma once

// Named laws, and variables that have them.

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

#include "estimators/estimator.h"
#include "estimators/stream.h"

namespace assay::analytic {

/// Mean and standard deviation.
struct NormalLaw {
  double mean = 0;
  double deviation = 1;

  /// Box & Muller (1958), the cosine of the pair.
  double operator()(Stream& random) const {
    const double radius = std::sqrt(-2 * std::log(random.uniform_open()));
    return mean + deviation * radius * std::cos(2 * std::numbers::pi * random.uniform());
  }
};

/// Reads `mean` and `deviation`.
NormalLaw normal_law(Parameters&);

/// A law by name and numbers, as "lognormal(0, 0.5)" says it.
class Law {
 public:
  struct Family;
  struct Facts {
    std::optional<double> mean;
    std::optional<double> variance;
    double low = -std::numeric_limits<double>::infinity();  ///< no value is below
    double high = std::numeric_limits<double>::infinity();  ///< no value is above
  };

  /// Throws std::invalid_argument, in words for the user, for what is no law.
  static Law parse(std::string_view text);

  double draw(Stream& random) const;
  /// dP/dx of a law that has a density.
  double density(double x) const;
  bool has_density() const;

  /// The mean and the variance, as far as they exist, and the range.
  const Facts& facts() const { return facts_; }

 private:
  Law(const Family& family, double a, double b);

  const Family* family_;
  double a_;
  double b_;
  Facts facts_;
};

/// X = shift + scale Y.
struct Variable {
  Law law;
  double shift;
  double scale;

  double operator()(Stream& random) const { return shift + scale * law.draw(random); }
};

/// The law that was given. InputError if it is no law.
Law law_of(Parameters& parameters);

/// Its mean, variance and range, as far as they exist.
Channel channel_of(const Variable& variable);

}  // namespace assay::analytic
