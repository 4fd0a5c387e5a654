#pragma once

// Named laws, and variables that have them.

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "estimators/core/first_words.h"
#include "estimators/estimator.h"
#include "estimators/stream.h"

namespace assay::analytic {

/// Mean and standard deviation.
struct NormalLaw {
  double mean = 0;
  double deviation = 1;

  /// Box & Muller (1958), the cosine of the pair. `random` is a Stream or reads as one.
  double operator()(auto& random) const {
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

/// Observations of one primary in batches, all others one by one: calibrations draw some millions
/// of them a second.
class VariableEstimator final : public Estimator {
 public:
  explicit VariableEstimator(const Variable& variable) : variable_(variable), means_(variable) {}

  void announce(const Announcement& next) override { ahead_.announce(next); }

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    const std::uint64_t index = random.observation();
    if (primaries != 1 || !ahead_.has(random.key(), index)) {
      means_.secondary(random, primaries, out, cost);
      return;
    }
    if (ahead_.reach(index)) draw_batch();
    out[0] = values_[ahead_.place(index)];
    cost.samples += 1;
  }

 private:
  void draw_batch() {
    const std::span<FirstWords> words = ahead_.words();
    variable_.law.draw(words, values_);
    for (double& value : std::span(values_).first(words.size())) {
      value = variable_.shift + variable_.scale * value;
    }
  }

  Variable variable_;
  AveragingEstimator<Variable> means_;
  AnnouncedWords ahead_;
  std::array<double, AnnouncedWords::batch> values_{};
};

}  // namespace assay::analytic
