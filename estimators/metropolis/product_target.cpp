#include "metropolis/product_target.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace assay::metropolis {

namespace {

double value(const Linear& f, double u) { return f.constant + f.slope * u; }
double value(const Gaussian& f, double u) {
  const double x = (u - f.centre) / f.width;
  return std::exp(-x * x / 2);
}
double value(const Decay& f, double u) { return std::exp(-f.rate * u); }

double integral(const Linear& f, double low, double high) {
  return (high - low) * (f.constant + f.slope * (low + high) / 2);
}
double integral(const Gaussian& f, double low, double high) {
  const double scale = f.width * std::numbers::sqrt2;
  // Tails on the side of the interval: a difference of numbers near 1 would lose them.
  const double sign = low > f.centre ? -1 : 1;
  const double from = sign * (low - f.centre) / scale;
  const double to = sign * (high - f.centre) / scale;
  return sign * f.width * std::sqrt(std::numbers::pi / 2) * (std::erfc(-to) - std::erfc(-from));
}
double integral(const Decay& f, double low, double high) {
  return std::exp(-f.rate * low) * -std::expm1(-f.rate * (high - low)) / f.rate;
}

std::size_t pixel_of(double u, std::size_t width) {
  return static_cast<std::size_t>(u * static_cast<double>(width));
}

std::vector<Spectrum> row_of_colours(std::size_t width, bool coloured) {
  std::vector<Spectrum> colours(width, Spectrum::grey(1));
  for (std::size_t p = 0; coloured && p < width; ++p) {
    const double t = static_cast<double>(p) / static_cast<double>(width - 1);
    colours[p] = {1 - 0.8 * t, 0.5, 0.2 + 0.8 * t};
  }
  return colours;
}

std::vector<Product> checked(std::vector<Product> sum) {
  if (sum.empty() || sum.size() > most_terms) {
    throw std::invalid_argument("ProductTarget: there must be from 1 to 32 products");
  }
  const std::size_t dimensions = sum.front().factors.size();
  if (dimensions == 0 || dimensions > most_terms) {
    throw std::invalid_argument("ProductTarget: there must be from 1 to 32 factors");
  }
  for (const Product& product : sum) {
    if (product.factors.size() != dimensions) {
      throw std::invalid_argument("ProductTarget: all products must have as many factors");
    }
  }
  return sum;
}

}  // namespace

double value(const Factor& factor, double u) {
  return std::visit([u](const auto& f) { return value(f, u); }, factor);
}

double integral(const Factor& factor, double low, double high) {
  return std::visit([=](const auto& f) { return integral(f, low, high); }, factor);
}

ProductTarget::ProductTarget(std::vector<Product> sum, std::size_t width, bool coloured)
    : sum_(checked(std::move(sum))),
      dimensions_(sum_.front().factors.size()),
      colours_(row_of_colours(width, coloured)),
      coloured_(coloured) {}

ImageShape ProductTarget::shape() const {
  ImageShape shape{.width = colours_.size(), .height = 1};
  if (coloured_) shape.components = {"red", "green", "blue"};
  return shape;
}

Contribution ProductTarget::at(Coordinates& point, Cost&) const {
  std::array<double, most_terms> products;
  for (std::size_t k = 0; k < sum_.size(); ++k) products[k] = sum_[k].height;
  std::size_t pixel = 0;
  for (std::size_t d = 0; d < dimensions_; ++d) {
    const double u = point.uniform();
    if (d == 0) pixel = pixel_of(u, colours_.size());
    for (std::size_t k = 0; k < sum_.size(); ++k) products[k] *= value(sum_[k].factors[d], u);
  }
  double f = 0;
  for (std::size_t k = 0; k < sum_.size(); ++k) f += products[k];
  const Spectrum value = f * colours_[pixel];
  return {pixel, value, coloured_ ? paths::luminance(value) : f};
}

std::vector<double> ProductTarget::means() const {
  const auto width = static_cast<double>(colours_.size());
  std::vector<double> all;
  for (std::size_t p = 0; p < colours_.size(); ++p) {
    const auto left = static_cast<double>(p);
    double sum = 0;
    for (const Product& term : sum_) {
      double product =
          term.height * width * integral(term.factors[0], left / width, (left + 1) / width);
      for (std::size_t d = 1; d < dimensions_; ++d) product *= integral(term.factors[d], 0, 1);
      sum += product;
    }
    for (std::size_t c = 0; c < (coloured_ ? 3 : 1); ++c) {
      all.push_back(sum * component(colours_[p], c));
    }
  }
  return all;
}

ImageShape BranchingTarget::shape() const { return {.width = form_.width, .height = 1}; }

Contribution BranchingTarget::at(Coordinates& point, Cost&) const {
  constexpr std::size_t stripes = 32;
  const std::size_t pixel = pixel_of(point.uniform(), stripes * form_.width) % form_.width;
  const double f = pixel % 2 == 0
                       ? form_.level
                       : form_.lobe.height * value(form_.lobe.factors[0], point.uniform());
  return {pixel, Spectrum::grey(f), f};
}

std::vector<double> BranchingTarget::means() const {
  std::vector<double> all;
  for (std::size_t p = 0; p < form_.width; ++p) {
    all.push_back(p % 2 == 0 ? form_.level
                             : form_.lobe.height * integral(form_.lobe.factors[0], 0, 1));
  }
  return all;
}

}  // namespace assay::metropolis
