// Mutants of steerable importance sampling: its parts with one replaced. Biases are given for two
// skies of suites/steerable.yaml, at level 4. The smooth one is of nine harmonics. The peaked one
// is 0.2 + 20 e^(60 (cos - 1)) about (.3, .2, .8).

#include <bit>
#include <functional>
#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/mutant.h"
#include "render/share_table.h"
#include "sky/directions.h"
#include "steerable/directions.h"
#include "steerable/triangle.h"

namespace assay::plugins {

namespace {

using namespace steerable;
using sky::Direction;
using sky::Directions;
using sky::Outcome;
using sky::SharedDirections;
using sky::SharedSetting;

struct NoMeasure {
  double operator()(const Vector3&, double) const { return 1; }
};

struct Transcribed {
  TrianglePoint operator()(const VertexWeights& w, double x, double y) const {
    const double s = linear_distance(w, x);
    const double total = s * (w.c - w.b) + 2 * (1 - s) * w.a + s * w.b;
    if (!(total > 0)) return {0, 0};
    const double rho = 2 * ((1 - s) * w.a + s * w.b) / total;
    const double gamma = s * (w.c - w.b) / total;
    const double root = rho + std::sqrt(std::max(0.0, rho * rho + 4 * gamma * y));
    const double t = root > 0 ? std::min(1.0, 2 * y / root) : 0;
    return {s * (1 - t), s * t};
  }
};

double positive(double x) { return std::max(0.0, x); }

class ClampedDirections final : public Directions {
 public:
  ClampedDirections(std::shared_ptr<const SkyTree> tree, const Lobe& lobe, render::Frame frame)
      : tree_(std::move(tree)),
        frame_(frame),
        a_(lobe_coefficients(lobe, frame.normal)),
        leaves_(mapped_indices(tree_->count(), [this](std::size_t t) {
          const auto [a, b, c] = tree_->sphere().corners(t);
          return length(cross(b - a, c - a)) / 6 * weights(t).sum();
        })) {}

  Domain domain() const override { return Domain::sphere; }
  Direction draw(double u, double v) const override {
    const std::uint32_t triangle = leaves_.pick(u);
    const TrianglePoint point = LinearTriangle{}(weights(triangle), u, v);
    const auto [a, b, c] = tree_->sphere().corners(triangle);
    const Vector3 q = (1 - point.u - point.v) * a + point.u * b + point.v * c;
    const Vector3 w = frame_.to_local(normalised(q));
    return {w, density_at(triangle, q), static_cast<int>(std::bit_width(tree_->count())) - 1};
  }
  double density(const Vector3& local) const override {
    const Vector3 w = frame_.to_world(local);
    const std::size_t triangle = tree_->sphere().triangle(w);
    const auto [a, b, c] = tree_->sphere().corners(triangle);
    const Vector3 normal = cross(b - a, c - a);
    return density_at(triangle, dot(normal, a) / dot(normal, w) * w);
  }
  Panels panels() const override { return {.first = 32, .second = 64}; }

 private:
  VertexWeights weights(std::size_t triangle) const {
    const VertexWeights w = tree_->weights(triangle, a_);
    return {positive(w.a), positive(w.b), positive(w.c)};
  }
  double density_at(std::size_t triangle, const Vector3& q) const {
    const auto [a, b, c] = tree_->sphere().corners(triangle);
    const Vector3 normal = cross(b - a, c - a);
    const double square = squared_length(normal);
    const TrianglePoint point = {dot(cross(q - a, c - a), normal) / square,
                                 dot(cross(b - a, q - a), normal) / square};
    return point.weight(weights(triangle)) / tree_->node(1, a_) *
           PlaneToSphere{}(q, dot(normal, a) / std::sqrt(square));
  }

  std::shared_ptr<const SkyTree> tree_;
  render::Frame frame_;
  sky::Harmonics a_;
  render::ShareTable leaves_;
};

/// Another's directions at densities of one's own.
class Redeclared final : public Directions {
 public:
  Redeclared(SharedDirections directions, std::function<double(const Vector3&)> density)
      : directions_(std::move(directions)), density_(std::move(density)) {}

  Domain domain() const override { return directions_->domain(); }
  Direction draw(double u, double v) const override {
    Direction d = directions_->draw(u, v);
    d.density = density_(d.w);
    return d;
  }
  double density(const Vector3& w) const override { return density_(w); }
  Panels panels() const override { return directions_->panels(); }

 private:
  SharedDirections directions_;
  std::function<double(const Vector3&)> density_;
};

Outcome absolute_cosine(const sky::Setting& setting, const Direction& direction, Cost& cost) {
  if (direction.w.z > 0) return sky::outcome(setting, direction, cost);
  Outcome result{.below = 1, .nodes = static_cast<double>(direction.nodes)};
  if (!setting.visible(direction.w, cost)) return result;
  result.value = -direction.w.z / direction.density * setting.radiance(direction.w);
  return result;
}

/// The sound parts that a mutant starts from.
struct Parts {
  SharedSetting setting;
  std::shared_ptr<const SkyTree> tree;
  Lobe lobe;
  std::uint64_t strata;
};

using Steered = SteeredDirections<>;

std::shared_ptr<const Steered> steered(const Parts& parts) {
  return std::make_shared<const Steered>(parts.tree, parts.lobe, parts.setting->frame());
}

template <class Follow = decltype(&sky::outcome)>
std::shared_ptr<const Setup> with(const Parts& parts, SharedDirections directions,
                                  Follow follow = &sky::outcome) {
  return sky::sky_setup(
      sky::irradiance_channels(*parts.setting),
      sky::StratifiedPrimary<Follow>{parts.setting, directions, parts.strata, follow},
      std::make_shared<sky::DirectionSampler>(parts.setting, directions), true);
}

template <class Warp, class Measure>
std::shared_ptr<const Setup> replaced(const Parts& parts) {
  return with(parts, std::make_shared<const SteeredDirections<Warp, Measure>>(
                         parts.tree, parts.lobe, parts.setting->frame()));
}

std::shared_ptr<const Setup> clamped(const Parts& parts, double offset) {
  const Lobe lobe{.coefficients = parts.lobe.coefficients, .offset = offset};
  return with(parts,
              std::make_shared<const ClampedDirections>(parts.tree, lobe, parts.setting->frame()));
}

std::shared_ptr<const Setup> analytic_normaliser(const Parts& parts) {
  const auto sound = steered(parts);
  sky::Rgb irradiance;
  for (std::size_t c = 0; c < parts.setting->colours(); ++c) {
    irradiance[c] = parts.setting->radiance().irradiance(parts.setting->frame().normal, c).value;
  }
  const double factor = sound->total() / parts.setting->grey(irradiance);
  return with(parts, std::make_shared<const Redeclared>(sound, [sound, factor](const Vector3& w) {
                return factor * sound->density(w);
              }));
}

std::shared_ptr<const Setup> map_density(const Parts& parts) {
  const auto sound = steered(parts);
  const auto density = [sound, parts](const Vector3& w) {
    const double grey = parts.setting->grey(parts.setting->radiance(w));
    return grey * lobe_value(parts.lobe, w.z) / sound->total();
  };
  return with(parts, std::make_shared<const Redeclared>(sound, density));
}

std::shared_ptr<const Setup> flipped(const Parts& parts) {
  const auto sound = steered(parts);
  return with(parts, sound, [sound](const sky::Setting& setting, Direction d, Cost& cost) {
    if (d.w.z <= 0) d = {-d.w, sound->density(-d.w), d.nodes};
    return sky::outcome(setting, d, cost);
  });
}

std::shared_ptr<const Setup> redrawn(const Parts& parts) {
  const auto sound = steered(parts);
  const auto primary = [sound, parts](Stream& random, Cost& cost) {
    const auto k = static_cast<double>(parts.strata);
    Outcome sum;
    cost.samples += parts.strata;
    for (std::uint64_t j = 0; j < parts.strata; ++j) {
      Direction d;
      do {
        const double u = (static_cast<double>(j) + random.uniform()) / k;
        d = sound->draw(u, random.uniform());
      } while (d.w.z <= 0);
      sum += sky::outcome(*parts.setting, d, cost) / k;
    }
    return sum;
  };
  return sky::sky_setup(sky::irradiance_channels(*parts.setting), primary,
                        std::make_shared<sky::DirectionSampler>(parts.setting, sound), true);
}

Entry entry(const char* name, const char* defect,
            std::function<std::shared_ptr<const Setup>(const Parts&)> of) {
  return mutant({name, "steerable/sky", defect}, [of = std::move(of)](Parameters& given) {
    const SharedSetting setting = sky::read_setting(given);
    return of({.setting = setting,
               .tree = read_tree(given, *setting),
               .lobe = read_lobe(given),
               .strata = given.count("strata")});
  });
}

}  // namespace

std::vector<Entry> mutants_steerable() {
  return {
      entry("steerable_no_jacobian",
            "forgets |q|^3 / d, which turns the density per area into one per solid angle; -0.3 % "
            "(smooth and peaked), at level 2 -5 %.",
            replaced<LinearTriangle, NoMeasure>),
      entry("steerable_transcribed",
            "samples triangles with s b for 2 s b in T; less than 0.1 % (smooth), +0.26 % "
            "(peaked); other orders of the triangles' vertices give other biases.",
            replaced<Transcribed, PlaneToSphere>),
      entry("steerable_no_offset",
            "leaves the offset away and clamps negative weights, but not in the normaliser; -3.2 % "
            "(smooth), -0.74 % (peaked).",
            [](const Parts& parts) { return clamped(parts, 0); }),
      entry("steerable_small_offset",
            "has the offset 0.09 and clamps negative weights, but not in the normaliser; -0.68 % "
            "(smooth), -0.16 % (peaked).",
            [](const Parts& parts) { return clamped(parts, 0.09); }),
      entry("steerable_analytic_normaliser",
            "divides by the analytic irradiance instead of the root's weight; -14.5 % (smooth), "
            "-9.0 % (peaked).",
            analytic_normaliser),
      entry("steerable_redrawn",
            "draws again where a direction falls below the horizon, at an unchanged density; +8.7 "
            "% (smooth), +2.0 % (peaked).",
            redrawn),
      entry("steerable_absolute_cosine",
            "takes the cosine absolutely, so that the sky below the horizon shines; +122 % "
            "(smooth), +25 % (peaked).",
            [](const Parts& parts) { return with(parts, steered(parts), &absolute_cosine); }),
      entry("steerable_map_density",
            "declares the density of the sky times the lobe itself, not that of their interpolant "
            "on triangles, which is drawn from; -0.44 % (smooth), +0.12 % (peaked).",
            map_density),
      entry("steerable_flipped",
            "turns directions below the horizon round without adding the density of the direction "
            "that they came from; +7.1 % (smooth), +1.5 % (peaked).",
            flipped),
      mutant({"triangle_transcribed", "steerable/triangle",
              "takes T with s b for 2 s b, so that the second coordinate does not reach the far "
              "side."},
             [](Parameters& given) {
               return triangle_setup<Transcribed>(read_weights(given), false);
             }),
  };
}

}  // namespace assay::plugins
