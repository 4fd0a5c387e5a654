#include "stats/images/image_constants.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "stats/basics/moments.h"
#include "stats/means/constant_sample.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

const DeclaredValues& declared_at(const Declarations& all, std::size_t element) {
  return all[all.size() == 1 ? 0 : element];
}

// The value of a constant, and the range of the law whose other values it can have missed.
struct Missing : ConstantSample {
  // Tests it against a mean that is known or estimated.
  double log_p(const Reference& mean) const {
    return log_p_constant({value, std::min(low, value), std::max(high, value), count}, mean);
  }
  double sign(const Reference& mean) const { return value < mean.value ? -1 : 1; }
  bool bounded(const Reference& mean) const {
    return std::isfinite(mean.value < value ? low : high);
  }
};

class ScannedSide {
 public:
  explicit ScannedSide(SettledSide side) : side_(std::move(side)) {}

  const DeclaredValues& declared(std::size_t element) const {
    return declared_at(side_.declared, element);
  }
  double value(std::size_t element) const { return side_.stack.images[0][element]; }
  // True if values of the element last looked at differ by rounding.
  bool was_rounded() const { return low_ < high_; }

  // Looks at the element's values until they are seen to vary, nearly always at the second.
  bool is_constant(std::size_t element) {
    low_ = high_ = value(element);
    return std::ranges::all_of(side_.stack.images, [&](std::span<const float> image) {
      const double number = image[element];
      low_ = std::min(low_, number);
      high_ = std::max(high_, number);
      return high_ - low_ <= 2 * declared(element).error(low_);
    });
  }
  Missing missing(std::size_t element) const {
    return {
        {value(element), declared(element).low, declared(element).high, side_.stack.images.size()}};
  }
  // An end that is not declared is as far away as the values of the elements around.
  Missing missing_beside_others(std::size_t element) {
    Missing missing = this->missing(element);
    if (std::isfinite(missing.low) && std::isfinite(missing.high)) return missing;
    const double size = size_around(element);
    if (!std::isfinite(missing.low)) missing.low = missing.value - size;
    if (!std::isfinite(missing.high)) missing.high = missing.value + size;
    return missing;
  }
  Reference mean(std::size_t element) const {
    Moments moments;
    add_to(moments, element);
    return {moments.mean, moments.standard_error()};
  }

  // Gives the element this value in every image.
  void settle(std::size_t element, double number) { settled_.push_back({element, number}); }
  // Call it after the last element.
  void replace(ChangedImages& changed) {
    if (settled_.empty()) return;
    for (std::span<const float>& image : side_.stack.images) {
      std::vector<float>& copy = changed.emplace_back(image.begin(), image.end());
      for (const auto& [element, number] : settled_) copy[element] = static_cast<float>(number);
      image = copy;
    }
  }

 private:
  // Beside others that never varied the whole image tells it: what makes constants is common there.
  double size_around(std::size_t element) {
    constexpr std::size_t reach = 4;
    const ImageExtent& extent = side_.stack.extent;
    const std::size_t column = element % extent.row() / extent.channels;
    const std::size_t row = element / extent.row();
    Moments around;
    for (std::size_t y = row - std::min(row, reach); y <= row + reach && y < extent.height; ++y) {
      const std::size_t first = column - std::min(column, reach);
      for (std::size_t x = first; x <= column + reach && x < extent.width; ++x) {
        const std::size_t other =
            y * extent.row() + x * extent.channels + element % extent.channels;
        if (other != element && is_constant(other)) return size_in_image(element);
        add_to(around, other);
      }
    }
    return size_about(value(element), around);
  }
  double size_in_image(std::size_t element) {
    if (all_.count == 0) {
      for (std::size_t i = 0; i < side_.stack.extent.elements(); ++i) add_to(all_, i);
    }
    return size_about(value(element), all_);
  }
  void add_to(Moments& values, std::size_t element) const {
    for (const std::span<const float> image : side_.stack.images) values.add(image[element]);
  }

  SettledSide side_;
  double low_ = 0;  // The range of the element last looked at, if it is constant.
  double high_ = 0;
  Moments all_;  // Every value, once they are asked for.
  std::vector<std::pair<std::size_t, double>> settled_;
};

}  // namespace

double DeclaredValues::error(double value) const {
  return rounding + precision * (std::abs(value) + std::abs(value - offset));
}

Declarations of_differences(Declarations one, const Declarations& other,
                            std::span<const float> image) {
  one.resize(std::max(one.size(), other.size()), one[0]);
  for (std::size_t i = 0; i < one.size(); ++i) {
    one[i].rounding = one[i].error(image[i]) + declared_at(other, i).error(image[i]);
  }
  return one;
}

ImageConstants settle_constants(SettledSide declared, std::vector<double>& reference,
                                std::vector<double>& error, bool of_pairs, ChangedImages& changed) {
  ImageConstants constants;
  ScannedSide side(std::move(declared));
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (!side.is_constant(i)) continue;
    const double constant = side.value(i);
    const Reference expected{reference[i], error.empty() ? 0 : error[i]};
    const bool differs =
        std::abs(constant - expected.value) > side.declared(i).error(expected.value);
    if (differs && of_pairs) continue;
    ++constants.count;
    if (side.was_rounded()) side.settle(i, constant);
    if (differs) {
      const Missing missing = side.missing_beside_others(i);
      constants.unseen.push_back({i, missing.sign(expected), missing.log_p(expected)});
      continue;
    }
    reference[i] = constant;
    if (!error.empty()) error[i] = 0;
  }
  if (std::ranges::all_of(error, [](double each) { return each == 0; })) error.clear();
  side.replace(changed);
  return constants;
}

ImageConstants settle_constants(SettledSide first, SettledSide second, ChangedImages& changed) {
  ImageConstants constants;
  const std::size_t elements = first.stack.extent.elements();
  ScannedSide one(std::move(first));
  ScannedSide two(std::move(second));
  for (std::size_t i = 0; i < elements; ++i) {
    const bool first_constant = one.is_constant(i);
    const bool second_constant = two.is_constant(i);
    if (!first_constant && !second_constant) continue;
    if (first_constant && second_constant) {
      ++constants.count;
      const double a = one.value(i);
      const double b = two.value(i);
      const bool equal = std::abs(a - b) <= one.declared(i).error(a) + two.declared(i).error(b);
      one.settle(i, a);
      two.settle(i, equal ? a : b);
      continue;
    }
    const Missing missing = (first_constant ? one : two).missing(i);
    const Reference mean = (first_constant ? two : one).mean(i);
    if (!missing.bounded(mean)) continue;
    const double sign = first_constant ? missing.sign(mean) : -missing.sign(mean);
    constants.unseen.push_back({i, sign, missing.log_p(mean)});
    one.settle(i, missing.value);
    two.settle(i, missing.value);
  }
  one.replace(changed);
  two.replace(changed);
  return constants;
}

}  // namespace assay::stats
