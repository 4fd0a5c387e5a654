#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "analytic/law.h"
#include "estimators/estimator.h"
#include "estimators/first_words.h"

namespace assay::analytic {

/// X = shift + scale Y.
struct Variable {
  Law law;
  double shift;
  double scale;

  double operator()(Stream& random) const { return shift + scale * law.draw(random); }
};

/// Observations of one primary in batches, all others one by one: calibrations draw some millions
/// of them a second.
class VariableEstimator final : public Estimator {
 public:
  explicit VariableEstimator(const Variable& variable) : variable_(variable), means_(variable) {}

  void announce(const Announcement& next) override {
    announced_ = next;
    first_ = last_ = next.first;
  }

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    const std::uint64_t index = random.observation();
    if (primaries != 1 || !is_announced(random.key(), index)) {
      means_.secondary(random, primaries, out, cost);
      return;
    }
    if (index < first_ || index >= last_) draw_batch(index);
    out[0] = values_[index - first_];
    cost.samples += 1;
  }

 private:
  static constexpr std::uint64_t batch = 256;

  bool is_announced(StreamKey key, std::uint64_t index) const {
    return key == announced_.key && index >= announced_.first && index < announced_.last;
  }

  void draw_batch(std::uint64_t from) {
    first_ = from;
    last_ = std::min(from + batch, announced_.last);
    const std::span words = std::span(words_).first(last_ - first_);
    first_words(announced_.key, first_, words);
    variable_.law.draw(words, values_);
    for (double& value : std::span(values_).first(words.size())) {
      value = variable_.shift + variable_.scale * value;
    }
  }

  Variable variable_;
  AveragingEstimator<Variable> means_;
  Announcement announced_{};
  std::uint64_t first_ = 0;  // of those in `values_`
  std::uint64_t last_ = 0;
  std::array<FirstWords, batch> words_{};
  std::array<double, batch> values_{};
};

}  // namespace assay::analytic
