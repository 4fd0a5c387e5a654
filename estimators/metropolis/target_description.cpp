#include "metropolis/target_description.h"

#include <utility>

#include "estimators/core/flow.h"
#include "estimators/core/value_checks.h"
#include "luminaire/scene_description.h"
#include "metropolis/product_target.h"
#include "metropolis/sphere_target.h"

namespace assay::metropolis {

namespace {

using luminaire::require_keys;
using luminaire::required_key;

std::size_t dimensions_of(const Value& value) {
  const std::uint64_t count = value.count("`dimensions`");
  if (count < 1 || count > most_terms) {
    throw InputError(value.where(), "`dimensions` must be from 1 to 32");
  }
  return count;
}

/// A number for all coordinates, or a list with one for each.
std::vector<double> centre_of(const Value& value, std::size_t dimensions) {
  if (value.kind() != Value::Kind::list) {
    return std::vector<double>(dimensions, finite_number(value, "a lobe's centre"));
  }
  if (value.items().size() != dimensions) {
    throw InputError(value.where(), "a lobe's centre must have a number for each of the " +
                                        std::to_string(dimensions) + " dimensions");
  }
  std::vector<double> centre;
  for (const Value& item : value.items()) centre.push_back(finite_number(item, "a lobe's centre"));
  return centre;
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
  const std::size_t dimensions = dimensions_of(required_key(value, "the mixture", "dimensions"));
  const Value& base = required_key(value, "the mixture", "base");
  const Value& lobes = required_key(value, "the mixture", "lobes");
  if (lobes.kind() != Value::Kind::list || lobes.items().size() >= most_terms) {
    throw InputError(lobes.where(), "`lobes` must be a list of fewer than 32");
  }
  std::vector<Product> sum = {
      {at_least_zero(base, "the mixture's base"), std::vector<Factor>(dimensions, Linear{})}};
  double largest = sum[0].height;
  for (const Value& item : lobes.items()) {
    sum.push_back(lobe_of(item, dimensions));
    largest = std::max(largest, sum.back().height);
  }
  if (largest == 0) throw InputError(base.where(), "the mixture must not be 0 everywhere");
  return std::make_shared<ProductTarget>(std::move(sum), pixels, false);
}

SharedTarget peak(std::size_t pixels, bool coloured) {
  return std::make_shared<ProductTarget>(
      std::vector<Product>{{1, {Linear{0.05, 0.5}, Linear{}}},
                           {40, {Gaussian{0.3, 0.02}, Gaussian{0.7, 0.02}}}},
      pixels, coloured);
}

SharedTarget sphere_of(const paths::SceneDescription& scene, double survival, std::size_t pixels) {
  return std::make_shared<SphereTarget>(
      SphereTarget::Form{.scene = std::get<paths::SphereScene>(scene.form),
                         .grey = scene.grey,
                         .width = pixels,
                         .survival = survival});
}

/// The zones as a scene of paths, whose camera nobody looks through here.
paths::SceneDescription zones_of(const Value& zones, const std::string& folder) {
  const Value camera = parse_flow("{position: [0, 0, 0], direction: [0, 0, 1]}");
  return paths::read_scene(Value::map({{"zones", zones}, {"camera", camera}}, zones.where()),
                           folder);
}

SharedTarget read_sphere(const Value& value, std::size_t pixels, const std::string& folder) {
  require_keys(value, "the sphere", {"zones", "survival"});
  const Value& survival = required_key(value, "the sphere", "survival");
  const double q = above_zero(survival, "the sphere's survival");
  if (q >= 1) throw InputError(survival.where(), "the sphere's survival must be below 1");
  return sphere_of(zones_of(required_key(value, "the sphere", "zones"), folder), q, pixels);
}

SharedTarget named(Parameters& given, const std::string& name, std::size_t pixels) {
  if (name == "constant") {
    return std::make_shared<ProductTarget>(std::vector<Product>{{1, {Linear{}, Linear{}}}}, pixels,
                                           false);
  }
  if (name == "peak" || name == "coloured_peak") return peak(pixels, name != "peak");
  if (name == "boundary") {
    return std::make_shared<ProductTarget>(
        std::vector<Product>{{0.02, {Linear{}}}, {1, {Decay{20}}}}, pixels, false);
  }
  if (name == "mixture") {
    return mixture_of(parse_flow("{dimensions: 4, base: 0.02, lobes: [{height: 30, centre: 0.3, "
                                 "width: 0.1}, {height: 60, centre: 0.7, width: 0.08}]}"),
                      pixels);
  }
  if (name == "branches") {
    return std::make_shared<BranchingTarget>(
        BranchingTarget::Form{pixels, 1, {100, {Gaussian{0.5, 0.004}}}});
  }
  if (name == "sphere" || name == "coloured_sphere") {
    return sphere_of(paths::read_scene(Value::scalar(name), given.folder()), 0.8, pixels);
  }
  given.refuse("target", "there is no target `" + name + "`" +
                             luminaire::alternatives(
                                 name, {"constant", "peak", "coloured_peak", "boundary", "mixture",
                                        "branches", "sphere", "coloured_sphere"}));
}

}  // namespace

std::vector<ParameterInformation> target_parameters() {
  return {{.name = "target",
           .type = ParameterType::structure,
           .summary = "the integrand: constant, peak, coloured_peak, boundary, mixture, branches, "
                      "sphere or coloured_sphere, or a map with the key mixture or sphere",
           .fallback = "peak"},
          {.name = "pixels",
           .type = ParameterType::count,
           .summary = "pixels of the row that the first coordinate runs along",
           .fallback = "8",
           .low = 2,
           .high = 4096}};
}

SharedTarget read_target(Parameters& given) {
  const Value& target = given.structure("target");
  const std::size_t pixels = given.count("pixels");
  if (target.kind() == Value::Kind::scalar) return named(given, target.text(), pixels);
  if (target.kind() != Value::Kind::map || target.members().size() != 1) {
    given.refuse("target", "must be a name or a map with one key: mixture or sphere");
  }
  require_keys(target, "the target", {"mixture", "sphere"});
  const auto& [kind, value] = target.members()[0];
  return kind == "mixture" ? mixture_of(value, pixels) : read_sphere(value, pixels, given.folder());
}

}  // namespace assay::metropolis
