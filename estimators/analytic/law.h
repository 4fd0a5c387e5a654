#pragma once

// Named laws, and variables that have them.

#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

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
  enum class Family {
    bernoulli,
    exponential,
    lognormal,
    normal,
    student_t,
    uniform,
    zero_inflated
  };

  /// Throws std::invalid_argument, in words for the user, for what is no law.
  static Law parse(std::string_view text);

  double draw(Stream& random) const;
  /// dP/dx where the law has a density.
  double density(double x) const;
  bool has_density() const;

  std::optional<double> mean() const;
  std::optional<double> variance() const;
  double low() const;   ///< no value is below
  double high() const;  ///< no value is above

 private:
  Law(Family family, const std::vector<double>& numbers)
      : family_(family), a_(numbers[0]), b_(numbers.size() > 1 ? numbers[1] : 0) {}

  Family family_;
  double a_;
  double b_;
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
