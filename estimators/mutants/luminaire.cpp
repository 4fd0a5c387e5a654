// Mutants of the luminaire family: the parts of the sound estimators with one replaced.
//
// Expected biases are for the built-in scene `triangle` unless said otherwise; those of the maps
// depend on the order of its vertices.

#include <functional>

#include "estimators/core/mapped.h"
#include "estimators/mutant.h"
#include "luminaire/area.h"
#include "luminaire/solid_angle.h"

namespace assay::plugins {

namespace {

using namespace luminaire;
using render::SphericalTriangle;
using render::Vector3;

// Replacements for the map of the unit square to the triangle.

struct UnwarpedTriangle {
  Barycentric operator()(double x, double y) const { return {x, y * (1 - x)}; }
};

struct UnitSquare {
  Barycentric operator()(double x, double y) const { return {x, y}; }
};

// Replacements for Arvo's two steps.

/// The point of the arc between two unit vectors that is at this share of its angle.
Vector3 along_arc(const Vector3& from, const Vector3& to, double share) {
  const double angle = share * render::angle_between(from, to);
  const Vector3 axis = normalised(cross(from, to));
  return std::cos(angle) * from + std::sin(angle) * cross(axis, from);
}

struct UniformArc {
  Vector3 operator()(const SphericalTriangle& triangle, double u, double v) const {
    return triangle.arc_point(along_arc(triangle.a(), triangle.c(), u), v);
  }
};

struct UniformAngle {
  Vector3 operator()(const SphericalTriangle& triangle, double u, double v) const {
    return along_arc(triangle.b(), triangle.edge_point(u), v);
  }
};

Entry entry(const Mutant& its,
            const std::function<std::shared_ptr<const Setup>(SharedSetting)>& make) {
  return mutant(its, [make](Parameters& parameters) { return make(read_setting(parameters)); });
}

using Term = double (*)(const Connection&);

Entry term_mutant(const char* name, const char* defect, Term term) {
  return entry({name, "luminaire/area", defect}, [term](SharedSetting setting) {
    return averaging(only_mean(area_channel(*setting)),
                     AreaPrimary<UniformTriangle, Term>(setting, term), point_samplers<>(setting));
  });
}

template <class Map>
Entry arvo_mutant(const char* name, const char* defect) {
  return entry({name, "luminaire/solid_angle", defect}, [](SharedSetting setting) {
    return averaging(only_mean(solid_angle_channel(*setting)), SolidAnglePrimary<Map>(setting),
                     solid_angle_samplers<Map>(setting));
  });
}

std::shared_ptr<const Setup> half_dropped(SharedSetting setting) {
  const auto primary = [area = AreaPrimary<>(setting)](Stream& random, Cost& cost) {
    const auto [index, x, y] = area.shares().choose(random);
    if (x + y > 1) return 0.0;
    return area.value(area.at(area.setting().triangles()[index], UnitSquare{}(x, y)), cost);
  };
  return averaging(only_mean(area_channel(*setting)), primary, point_samplers<UnitSquare>(setting));
}

// Mutants of luminaire/floor scale what some receivers get, as a wrong weight would.

struct Pixel {
  std::size_t x;
  std::size_t y;
};

/// The factor of a pixel of an image of this shape.
using Weight = std::function<double(const Pixel&, const ImageShape&)>;

/// A primary times a factor that is not 1 where it should be.
struct WeightedPrimary {
  AreaPrimary<> primary;
  double factor;

  LightSample draw(Stream& random) const { return primary.draw(random); }
  double value(const LightSample& sample, Cost& cost) const {
    return factor * primary.value(sample, cost);
  }
};

Entry entry(const char* name, const char* defect, Weight weight) {
  return mutant({name, "luminaire/floor", defect}, [weight = std::move(weight)](Parameters& given) {
    const Floor floor = read_floor(given);
    const auto primary = [&](std::size_t i) -> WeightedPrimary {
      const Pixel pixel{i % floor.shape.width, i / floor.shape.width};
      return {AreaPrimary<>(floor.settings[i]), weight(pixel, floor.shape)};
    };
    return imaging<WeightedPrimary>({floor.shape, mapped(floor_channels(floor), only_mean),
                                     mapped_indices(floor.settings.size(), primary)});
  });
}

}  // namespace

std::vector<Entry> mutants_luminaire() {
  return {
      term_mutant("no_cosine", "forgets the receiver's cosine: the result is L Omega; +13.8 %.",
                  [](const Connection& c) -> double {
                    if (c.receiver_height() <= 0) return 0;
                    return std::max(0.0, c.light_cosine()) / c.squared_distance;
                  }),
      term_mutant("no_light_cosine", "forgets the luminaire's cosine; +31.9 %.",
                  [](const Connection& c) -> double {
                    if (c.light_height <= 0) return 0;
                    return std::max(0.0, c.receiver_cosine()) / c.squared_distance;
                  }),
      term_mutant("no_change_of_variables",
                  "forgets light_cosine / r^2, which turns solid angle into area; +134 %.",
                  [](const Connection& c) {
                    return c.light_height > 0 ? std::max(0.0, c.receiver_cosine()) : 0;
                  }),
      term_mutant("inverse_distance", "divides by r, not r^2; +28.9 %.",
                  [](const Connection& c) { return GeometryTerm{}(c)*c.distance(); }),
      term_mutant("reversed_difference",
                  "takes the connection from the luminaire to the receiver and does not clamp: the "
                  "irradiance comes out negative; -200 %.",
                  [](const Connection& c) {
                    return -c.receiver_height() * c.light_height /
                           (c.squared_distance * c.squared_distance);
                  }),
      term_mutant(
          "absolute_cosine",
          "takes the receiver's cosine absolutely, so that a luminaire below the horizon shines: "
          "nothing on `triangle`, too bright where a luminaire crosses the horizon.",
          [](const Connection& c) {
            return std::abs(c.receiver_height()) * std::max(0.0, c.light_height) /
                   (c.squared_distance * c.squared_distance);
          }),
      term_mutant(
          "two_sided_light",
          "lets both sides of the luminaire emit: nothing where the emitting side faces the "
          "receiver; a luminaire that faces away shines.",
          [](const Connection& c) {
            return std::max(0.0, c.receiver_height()) * std::abs(c.light_height) /
                   (c.squared_distance * c.squared_distance);
          }),
      term_mutant("one_percent", "is scaled by 1.01; +1 %.",
                  [](const Connection& c) { return 1.01 * GeometryTerm{}(c); }),
      entry({"nonuniform_triangle", "luminaire/area",
             "maps (x, y) to (x, y (1 - x)), which is not uniform in the "
             "triangle, at the uniform density; -25.4 %."},
            [](SharedSetting setting) {
              return averaging(only_mean(area_channel(*setting)),
                               AreaPrimary<UnwarpedTriangle>(setting),
                               point_samplers<UnwarpedTriangle>(setting));
            }),
      entry({"half_dropped", "luminaire/area",
             "takes points of the unit square, counts those outside the "
             "triangle as zero and does not double the others; -50 %."},
            half_dropped),
      entry({"solid_angle_density", "luminaire/area",
             "divides points uniform in area by the density 1 / Omega of "
             "directions uniform in solid angle; -4.0 %."},
            [](SharedSetting setting) {
              const double density = SolidAnglePrimary<>(setting).solid_angle() / setting->area();
              const auto term = [density](const Connection& c) {
                return c.light_height > 0 ? density * std::max(0.0, c.receiver_cosine()) : 0;
              };
              return averaging(only_mean(area_channel(*setting)),
                               AreaPrimary<UniformTriangle, decltype(term)>(setting, term),
                               point_samplers<>(setting));
            }),
      entry({"unclipped_reference", "luminaire/area",
             "states as its mean Lambert's formula without clipping at the "
             "horizon; the estimator is sound. Nothing on `triangle`, wrong "
             "where a luminaire crosses the horizon."},
            [](SharedSetting setting) {
              Channel channel = only_mean(area_channel(*setting));
              if (channel.mean) channel.mean = unclipped_irradiance(*setting);
              return averaging(channel, AreaPrimary<>(setting), point_samplers<>(setting));
            }),
      arvo_mutant<UniformArc>("arvo_uniform_arc",
                              "takes c' uniform on the arc from a to c; +0.32 %."),
      arvo_mutant<UniformAngle>("arvo_uniform_angle",
                                "takes the angle from b uniform, not its cosine; -4.7 %."),
      entry("floor_hot_pixels", "is 30 % too bright in four single pixels.",
            [](const Pixel& p, const ImageShape& shape) {
              // Four pixels, away from each other and from the edges.
              const bool row =
                  p.y == shape.height / 4 || p.y == shape.height - 1 - shape.height / 4;
              const bool column =
                  p.x == shape.width / 3 || p.x == shape.width - 1 - shape.width / 3;
              return row && column ? 1.3 : 1;
            }),
      entry("floor_tile",
            "is 2 % too bright in one tile, a quarter of the width and of the height.",
            [](const Pixel& p, const ImageShape& shape) {
              const bool column = p.x >= shape.width / 2 && p.x < shape.width / 2 + shape.width / 4;
              const bool row = p.y >= shape.height / 2 && p.y < shape.height / 2 + shape.height / 4;
              return row && column ? 1.02 : 1;
            }),
      entry("floor_global", "is 0.4 % too bright in every pixel.",
            [](const Pixel&, const ImageShape&) { return 1.004; }),
      entry("floor_interlaced",
            "is 0.5 % too bright in the even rows and 0.5 % too dark in the odd ones: the "
            "image's mean is right.",
            [](const Pixel& p, const ImageShape&) { return p.y % 2 == 0 ? 1.005 : 0.995; }),
      entry(
          "floor_last_column", "is 10 % too dark in the last column, where a filter was cut off.",
          [](const Pixel& p, const ImageShape& shape) { return p.x + 1 == shape.width ? 0.9 : 1; }),
  };
}

}  // namespace assay::plugins
