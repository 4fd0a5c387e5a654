#include "metropolis/target.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/core/value.h"
#include "paths/path.h"
#include "paths/worlds.h"

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

/// Points fall into one pixel or another, and a chain stays near where it was.
ImageShape row_of(std::size_t width, bool coloured) {
  ImageShape shape{.width = width, .height = 1, .independent = false};
  if (coloured) shape.components = {"red", "green", "blue"};
  return shape;
}

std::vector<Rgb> row_of_colours(std::size_t width, bool coloured) {
  std::vector<Rgb> colours(width, Rgb::grey(1));
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

/// Paths of two lengths. The first coordinate crosses 32 stripes a pixel, of pixel 0, 1, 2 ... in
/// turn. Those of even pixels bring `level`, whatever else; those of odd ones look at a second
/// coordinate and bring `lobe` of it.
class BranchingTarget final : public Target {
 public:
  explicit BranchingTarget(std::size_t width) : width_(width) {}

  ImageShape shape() const override { return row_of(width_, false); }
  Contribution at(Coordinates& point, Cost&) const override {
    constexpr std::size_t stripes = 32;
    const std::size_t pixel = pixel_of(point.uniform(), stripes * width_) % width_;
    const double f =
        pixel % 2 == 0 ? level_ : lobe_.height * value(lobe_.factors[0], point.uniform());
    return {pixel, Rgb::grey(f), f};
  }
  std::vector<double> means() const override {
    return mapped_indices(width_, [&](std::size_t p) {
      return p % 2 == 0 ? level_ : lobe_.height * integral(lobe_.factors[0], 0, 1);
    });
  }

 private:
  std::size_t width_;
  double level_ = 1;
  Product lobe_{100, {Gaussian{0.5, 0.004}}};  ///< of one factor
};

/// Light transport to a row of receivers inside a sphere, by rays. Pixel p is the wall between two
/// heights of the unit sphere, one of `width` bands of equal area. Its element is the mean radiance
/// that leaves the band, Le + a (mean Le) / (1 - mean a) averaged over its area. A path is that of
/// paths/plain. It starts at a uniform point of the wall (two coordinates). At each vertex it goes
/// on with probability `survival` (one coordinate) in a cosine-distributed direction (two). It
/// brings what is emitted where it arrives.
class SphereTarget final : public Target {
 public:
  /// The camera is of no account: paths start at the wall.
  SphereTarget(const paths::SceneDescription& scene, double survival, std::size_t width)
      : sphere_(std::get<paths::SphereScene>(scene.form)),
        grey_(scene.grey),
        width_(width),
        survival_(survival),
        world_(sphere_, paths::Camera{{0, 0, 0}, {0, 0, 1}}) {}

  ImageShape shape() const override { return row_of(width_, !grey_); }
  Contribution at(Coordinates& point, Cost& cost) const override {
    const double u = point.uniform();
    const render::Vector3 position = render::direction_at(2 * u - 1, point.uniform());
    paths::Tally tally;
    paths::walk(world_, world_.zones().vertex(position), survival_, point, tally, cost);
    return {pixel_of(u, width_), tally.value, grey_ ? tally.value[0] : luminance(tally.value)};
  }
  std::vector<double> means() const override {
    const paths::ZonedScene& law = world_.zones().law();
    std::vector<double> all;
    for (std::size_t p = 0; p < width_; ++p) {
      const auto width = static_cast<double>(width_);
      const double low = 2 * static_cast<double>(p) / width - 1;
      const double high = 2 * static_cast<double>(p + 1) / width - 1;
      Rgb sum;
      double below = -1;
      for (std::size_t z = 0; z < law.zones.size(); ++z) {
        const double top = sphere_.zones[z].top;
        const double common = std::max(0.0, std::min(high, top) - std::max(low, below));
        const paths::Surface& surface = law.zones[z].surface;
        sum += common / (high - low) * (surface.emission + surface.diffuse * law.mean_radiance());
        below = top;
      }
      for (std::size_t c = 0; c < (grey_ ? 1 : 3); ++c) all.push_back(sum[c]);
    }
    return all;
  }

 private:
  paths::SphereScene sphere_;
  bool grey_;
  std::size_t width_;
  double survival_;
  paths::SphereWorld world_;
};

/// A number for all coordinates, or a list with one for each.
std::vector<double> centre_of(const Value& value, std::size_t dimensions) {
  if (value.kind() != Value::Kind::list) {
    return std::vector<double>(dimensions, finite_number(value, "a lobe's centre"));
  }
  value.require(value.items().size() == dimensions,
                "a lobe's centre must have a number for each of the " + std::to_string(dimensions) +
                    " dimensions");
  return mapped(value.items(),
                [](const Value& item) { return finite_number(item, "a lobe's centre"); });
}

Product lobe_of(const Value& value, std::size_t dimensions) {
  require_keys(value, "a lobe", {"height", "centre", "width"});
  const double width = above_zero(required_key(value, "a lobe", "width"), "a lobe's width");
  Product lobe{at_least_zero(required_key(value, "a lobe", "height"), "a lobe's height"), {}};
  for (const double centre : centre_of(required_key(value, "a lobe", "centre"), dimensions)) {
    lobe.factors.emplace_back(Gaussian{centre, width});
  }
  return lobe;
}

SharedTarget mixture_of(const Value& value, std::size_t pixels) {
  require_keys(value, "the mixture", {"dimensions", "base", "lobes"});
  const Value& number = required_key(value, "the mixture", "dimensions");
  const std::uint64_t dimensions = number.count("`dimensions`");
  number.require(dimensions >= 1 && dimensions <= most_terms, "`dimensions` must be from 1 to 32");
  const Value& base = required_key(value, "the mixture", "base");
  const Value& lobes = required_key(value, "the mixture", "lobes");
  lobes.require(lobes.kind() == Value::Kind::list && lobes.items().size() < most_terms,
                "`lobes` must be a list of fewer than 32");
  std::vector<Product> sum = {
      {at_least_zero(base, "the mixture's base"), std::vector<Factor>(dimensions, Linear{})}};
  double largest = sum[0].height;
  for (const Value& item : lobes.items()) {
    sum.push_back(lobe_of(item, dimensions));
    largest = std::max(largest, sum.back().height);
  }
  base.require(largest != 0, "the mixture must not be 0 everywhere");
  return std::make_shared<ProductTarget>(std::move(sum), pixels, false);
}

SharedTarget read_sphere(const Value& value, std::size_t pixels, const std::string& folder) {
  require_keys(value, "the sphere", {"zones", "survival"});
  const Value& survival = required_key(value, "the sphere", "survival");
  const double q = above_zero(survival, "the sphere's survival");
  survival.require(q < 1, "the sphere's survival must be below 1");
  const Value& zones = required_key(value, "the sphere", "zones");
  // A scene of paths, whose camera nobody looks through here.
  const Value camera = parse_flow("{position: [0, 0, 0], direction: [0, 0, 1]}");
  const Value scene = Value::map({{"zones", zones}, {"camera", camera}}, zones.where());
  return std::make_shared<SphereTarget>(paths::read_scene(scene, folder), q, pixels);
}

SharedTarget named(Parameters& given, const std::string& name, std::size_t pixels) {
  const auto sum_of = [&](std::vector<Product> products) {
    return std::make_shared<ProductTarget>(std::move(products), pixels, name == "coloured_peak");
  };
  if (name == "constant") return sum_of({{1, {Linear{}, Linear{}}}});
  if (name == "peak" || name == "coloured_peak") {
    return sum_of(
        {{1, {Linear{0.05, 0.5}, Linear{}}}, {40, {Gaussian{0.3, 0.02}, Gaussian{0.7, 0.02}}}});
  }
  if (name == "boundary") return sum_of({{0.02, {Linear{}}}, {1, {Decay{20}}}});
  if (name == "mixture") {
    return mixture_of(parse_flow("{dimensions: 4, base: 0.02, lobes: [{height: 30, centre: 0.3, "
                                 "width: 0.1}, {height: 60, centre: 0.7, width: 0.08}]}"),
                      pixels);
  }
  if (name == "branches") return std::make_shared<BranchingTarget>(pixels);
  if (name == "sphere" || name == "coloured_sphere") {
    return std::make_shared<SphereTarget>(paths::read_scene(Value::scalar(name), given.folder()),
                                          0.8, pixels);
  }
  given.refuse("target",
               "there is no target `" + name + "`" +
                   alternatives(name, {"constant", "peak", "coloured_peak", "boundary", "mixture",
                                       "branches", "sphere", "coloured_sphere"}));
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

ImageShape ProductTarget::shape() const { return row_of(colours_.size(), coloured_); }

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
  const Rgb value = f * colours_[pixel];
  return {pixel, value, coloured_ ? render::luminance(value) : f};
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
      all.push_back(sum * colours_[p][c]);
    }
  }
  return all;
}

std::vector<ParameterInformation> target_parameters() {
  return {structure_parameter(
              "target",
              "the integrand: constant, peak, coloured_peak, boundary, mixture, branches, "
              "sphere or coloured_sphere, or a map with the key mixture or sphere",
              "peak"),
          count_parameter("pixels", "pixels of the row that the first coordinate runs along", "8",
                          {2, 4096})};
}

SharedTarget read_target(Parameters& given) {
  const Value& target = given.structure("target");
  const std::size_t pixels = given.count("pixels");
  if (target.kind() == Value::Kind::scalar) return named(given, target.text(), pixels);
  given.require(target.members().size() == 1, "target",
                "must be a name or a map with one key: mixture or sphere");
  require_keys(target, "the target", {"mixture", "sphere"});
  const auto& [kind, value] = target.members()[0];
  return kind == "mixture" ? mixture_of(value, pixels) : read_sphere(value, pixels, given.folder());
}

}  // namespace assay::metropolis
