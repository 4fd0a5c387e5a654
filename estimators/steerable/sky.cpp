#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "sky/directions.h"
#include "steerable/directions.h"

namespace assay::steerable {

namespace {

std::string text_of(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

}  // namespace

sky::Harmonics lobe_coefficients(const Lobe& lobe, const render::Vector3& n) {
  sky::Harmonics a = sky::harmonics(n);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto band = static_cast<std::size_t>(std::sqrt(static_cast<double>(i)));
    a[i] = i < lobe.coefficients ? a[i] * sky::cosine_factor(band) : 0;
  }
  a[0] += lobe.offset;
  return a;
}

double lobe_value(const Lobe& lobe, double c) {
  constexpr double sphere = 4 * std::numbers::pi;
  double before = 0;
  double legendre = 1;
  double sum = lobe.offset / std::sqrt(sphere);
  for (std::size_t l = 0; l * l < lobe.coefficients; ++l) {
    const auto degree = static_cast<double>(l);
    sum += (2 * degree + 1) / sphere * sky::cosine_factor(l) * legendre;
    const double next = ((2 * degree + 1) * c * legendre - degree * before) / (degree + 1);
    before = legendre;
    legendre = next;
  }
  return sum;
}

double lobe_minimum(const Lobe& lobe) {
  // A polynomial of degree 4 at most: the least of many values is its minimum to 1e-9.
  constexpr int steps = 30000;
  double least = lobe_value(lobe, -1);
  for (int i = 1; i <= steps; ++i) {
    least = std::min(least, lobe_value(lobe, 2.0 * i / steps - 1));
  }
  return least;
}

SkyTree::SkyTree(const sky::Radiance& radiance, const Preparation& preparation)
    : sphere_(preparation.level), coefficients_(preparation.coefficients) {
  const double floor = preparation.floor * radiance.grey(radiance.mean());
  for (const sky::Vector3& w : sphere_.vertices()) {
    const double value = radiance.grey(radiance(w)) + floor;
    least_ = std::min(least_, value);
    const sky::Harmonics y = sky::harmonics(w);
    for (std::size_t i = 0; i < coefficients_; ++i) vertices_.push_back(value * y[i]);
  }
  nodes_.resize(2 * count() * coefficients_);
  for (std::size_t t = 0; t < count(); ++t) {
    const auto [a, b, c] = sphere_.corners(t);
    const double third_of_area = length(cross(b - a, c - a)) / 6;
    for (const std::uint32_t vertex : sphere_.triangles()[t]) {
      for (std::size_t i = 0; i < coefficients_; ++i) {
        nodes_[(count() + t) * coefficients_ + i] +=
            third_of_area * vertices_[vertex * coefficients_ + i];
      }
    }
  }
  for (std::size_t node = count() - 1; node > 0; --node) {
    for (std::size_t i = 0; i < coefficients_; ++i) {
      nodes_[node * coefficients_ + i] =
          nodes_[2 * node * coefficients_ + i] + nodes_[(2 * node + 1) * coefficients_ + i];
    }
  }
}

Lobe read_lobe(Parameters& given) {
  const Lobe lobe = {.coefficients = std::stoul(given.string("coefficients")),
                     .offset = given.number("offset")};
  const double least = lobe_minimum(lobe);
  if (least > 0) return lobe;
  const double needed = lobe.offset - least * std::sqrt(4 * std::numbers::pi);
  given.refuse("offset", "is " + text_of(lobe.offset) + ", so that the lobe falls to " +
                             text_of(least) + " and a density with it; it must be above " +
                             text_of(needed) + " for " + std::to_string(lobe.coefficients) +
                             " coefficients");
}

std::shared_ptr<const SkyTree> read_tree(Parameters& given, const sky::Setting& setting) {
  const auto tree = std::make_shared<const SkyTree>(
      setting.radiance(), Preparation{.level = given.count("level"),
                                      .coefficients = std::stoul(given.string("coefficients")),
                                      .floor = given.number("floor")});
  if (tree->least() > 0) return tree;
  given.refuse("floor",
               "must be above 0 for this sky: it is black at a vertex of the subdivision, and "
               "light between black vertices would never be looked for");
}

}  // namespace assay::steerable

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const sky::SharedSetting setting = sky::read_setting(given);
  const steerable::Lobe lobe = steerable::read_lobe(given);
  const auto directions = std::make_shared<const steerable::SteeredDirections<>>(
      steerable::read_tree(given, *setting), lobe, setting->frame());
  return sky::sky_setup(sky::irradiance_channels(*setting, directions->gain()),
                        sky::StratifiedPrimary<>{setting, directions, given.count("strata")},
                        std::make_shared<sky::DirectionSampler>(setting, directions), true);
}

}  // namespace

std::vector<Entry> steerable_sky() {
  return {{{.name = "steerable/sky",
            .summary = "Irradiance from a sky by steerable importance sampling.",
            .description =
                "Estimates the integral of L(w) max(0, n . w) V(w) by L cos+ V / p (Subr and Arvo "
                "2007). The sphere is cut into 8 4^level triangles; at their vertices the sky's "
                "luminance times spherical harmonics, summed over a binary tree. For the normal n "
                "nine coefficients turn the harmonics into the clamped cosine (plus an offset that "
                "keeps it positive: above 0.140319), and every node's weight is a scalar product. "
                "A sample descends the tree, draws a point q of a triangle with linear density, "
                "and has p = weight(q) / Z |q|^3 / d, Z the root's weight, d the distance of the "
                "triangle's plane. Directions below the horizon count as zero. Channels `below` "
                "(the part of them) and `nodes` (of the tree, passed through for a sample) are "
                "diagnostic. The sampler `direction` is in the receiver's frame (z along n).",
            .parameters = joined(
                sky::parameters(),
                {count_parameter("level", "how often the octahedron's triangles are cut into four",
                                 "4", {0, 7}),
                 text_parameter("coefficients", "spherical harmonics of the lobe", "9",
                                {"1", "4", "9", "25"}),
                 number_parameter("offset",
                                  "added to the lobe's first coefficient, to make it positive",
                                  "0.15", {0, 100}),
                 number_parameter("floor",
                                  "added to the luminance at vertices, as a part of the sky's mean",
                                  "0", {0, 1}),
                 sky::strata_parameter()})},
           prepare}};
}

}  // namespace assay::plugins
