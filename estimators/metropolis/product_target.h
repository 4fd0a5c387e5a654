#pragma once

// Integrands in closed form: sums of products of functions of one coordinate.

#include <variant>
#include <vector>

#include "metropolis/target.h"

namespace assay::metropolis {

/// a + b u.
struct Linear {
  double constant = 1;
  double slope = 0;
};
/// e^(-(u - centre)^2 / (2 width^2)).
struct Gaussian {
  double centre;
  double width;
};
/// e^(-rate u), rate above 0.
struct Decay {
  double rate;
};
/// A function of one coordinate, not negative on [0, 1].
using Factor = std::variant<Linear, Gaussian, Decay>;

double value(const Factor& factor, double u);
/// Over [low, high].
double integral(const Factor& factor, double low, double high);

/// The most products of a sum, and the most factors of a product.
inline constexpr std::size_t most_terms = 32;

/// height x the product of the factors of all coordinates.
struct Product {
  double height;
  std::vector<Factor> factors;
};

/// A sum F of products, without units. All have as many factors. The first coordinate runs along a
/// row of pixels. With `coloured` pixel p of n has the colour (1 - 0.8 t, 0.5, 0.2 + 0.8 t), t = p
/// / (n - 1). Throws std::invalid_argument for none, more than most_terms of either, and different
/// numbers of factors.
class ProductTarget final : public Target {
 public:
  ProductTarget(std::vector<Product> sum, std::size_t width, bool coloured);

  ImageShape shape() const override;
  Contribution at(Coordinates& point, Cost& cost) const override;
  std::vector<double> means() const override;

 private:
  std::vector<Product> sum_;
  std::size_t dimensions_;
  std::vector<Spectrum> colours_;  ///< of the pixels
  bool coloured_;
};

/// Paths of two lengths. The first coordinate crosses 32 stripes a pixel, of pixel 0, 1, 2 ... in
/// turn. Those of even pixels bring `level`, whatever else; those of odd ones look at a second
/// coordinate and bring `lobe` of it.
class BranchingTarget final : public Target {
 public:
  struct Form {
    std::size_t width;
    double level;
    Product lobe;  ///< of one factor
  };
  explicit BranchingTarget(Form form) : form_(std::move(form)) {}

  ImageShape shape() const override;
  Contribution at(Coordinates& point, Cost& cost) const override;
  std::vector<double> means() const override;

 private:
  Form form_;
};

}  // namespace assay::metropolis
