#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/first_words.h"
#include "estimators/stream.h"

namespace assay::analytic {

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
  /// draw() of each stream of which these are the first words: no law takes more than two.
  void draw(std::span<FirstWords> streams, std::span<double> values) const;
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

  /// The result of use(draw); `draw` is a function of a Stream or of its first words.
  auto with_family(const auto& use) const;

  Family family_;
  double a_;
  double b_;
};

}  // namespace assay::analytic
