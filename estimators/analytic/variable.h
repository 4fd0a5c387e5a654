#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "analytic/law.h"
#include "estimators/core/announced_words.h"
#include "estimators/estimator.h"

namespace assay::analytic {

/// X = shift + scale Y.
struct Variable {
  Law law;
  double shift;
  double scale;

  double operator()(Stream& random) const { return shift + scale * law.draw(random); }
};

/// The parameter `law` of an estimator of a variable.
ParameterInformation law_parameter();

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
