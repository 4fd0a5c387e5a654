#include "depth_of_field/scene_description.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/core/value.h"

namespace assay::depth_of_field {

namespace {

Interval interval(const Value& value, const std::string& what) {
  value.require(value.items().size() == 2, what + " must be a list of two numbers, low and high");
  const Interval out{finite_number(value.items()[0], what), finite_number(value.items()[1], what)};
  value.require(out.low < out.high, what + " must ascend: nothing lies between its ends");
  return out;
}

Lens lens(const Value& value) {
  require_keys(value, "the lens", {"radius", "focus"});
  return {above_zero(required_key(value, "the lens", "radius"), "the lens's radius"),
          above_zero(required_key(value, "the lens", "focus"), "the lens's focus")};
}

Texture texture(const Value& value) {
  Texture out{.mean =
                  at_least_zero(required_key(value, "a plane", "radiance"), "a plane's radiance")};
  const Value* const amplitude = value.find("amplitude");
  const Value* const wavelength = value.find("wavelength");
  const Value* const phase = value.find("phase");
  value.require(!amplitude == !wavelength && (amplitude || !phase),
                "a sinusoid needs `amplitude` and `wavelength`, and may have a `phase`");
  if (!amplitude) return out;
  out.amplitude = at_least_zero(*amplitude, "a plane's amplitude");
  amplitude->require(out.amplitude <= out.mean,
                     "a plane's amplitude must not exceed its radiance, or the radiance would be "
                     "negative in its troughs");
  out.frequency = 2 * std::numbers::pi / above_zero(*wavelength, "a plane's wavelength");
  if (phase) out.phase = finite_number(*phase, "a plane's phase");
  return out;
}

Plane plane(const Value& value) {
  require_keys(value, "a plane",
               {"depth", "x", "y", "radiance", "amplitude", "wavelength", "phase"});
  return {.depth = above_zero(required_key(value, "a plane", "depth"), "a plane's depth"),
          .x = interval(required_key(value, "a plane", "x"), "a plane's x"),
          .y = interval(required_key(value, "a plane", "y"), "a plane's y"),
          .texture = texture(value)};
}

bool overlap(const Interval& a, const Interval& b) { return a.low < b.high && b.low < a.high; }

// Which of two at one depth is seen would be left to rounding.
void require_apart(const std::vector<Plane>& planes, const Value& blame) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Plane& a = planes[i];
      const Plane& b = planes[j];
      if (std::abs(a.depth - b.depth) > 1e-5 * a.depth) continue;
      blame.require(!overlap(a.x, b.x) || !overlap(a.y, b.y),
                    "two planes of one depth overlap: which is seen there?");
    }
  }
}

constexpr NamedScene built_in[] = {
    // A black half-plane before a sharp white one: discs of confusion of radius 0.1 on the half-
    // plane, 0.2 on the focal plane.
    {"edge",
     "{lens: {radius: .2, focus: 2}, planes: ["
     "{depth: 1, x: [0, 100], y: [-100, 100], radiance: 0}, "
     "{depth: 2, x: [-100, 100], y: [-100, 100], radiance: 1}]}"},
    // 1/2 + 1/2 cos behind the focal plane: discs of radius 0.2, three radians of the wave.
    {"sinusoid",
     "{lens: {radius: .2, focus: 2}, planes: ["
     "{depth: 4, x: [-100, 100], y: [-100, 100], radiance: .5, amplitude: .5, "
     "wavelength: .41887902047863907}]}"},
    // A sharp book on a sharp wall with a near strip across it, out of focus, bright as a lamp.
    {"strip",
     "{lens: {radius: .06, focus: 4}, planes: ["
     "{depth: 2, x: [-.1, .1], y: [-100, 100], radiance: 4}, "
     "{depth: 3.9, x: [-.8, .9], y: [-.4, .6], radiance: .6, amplitude: .2, wavelength: .4}, "
     "{depth: 4.1, x: [-100, 100], y: [-100, 100], radiance: 1, amplitude: .2, wavelength: .7}]}"},
    // A sharp head before lights far behind.
    {"portrait",
     "{lens: {radius: .1, focus: 2}, background: .02, planes: ["
     "{depth: 2, x: [-.5, .6], y: [-1, .5], radiance: .6, amplitude: .3, wavelength: .15}, "
     "{depth: 8, x: [-3.4, -2.6], y: [1, 1.8], radiance: 8}, "
     "{depth: 8, x: [2.7, 3.5], y: [.4, 1.2], radiance: 8}, "
     "{depth: 9, x: [-100, 100], y: [-100, 2.5], radiance: .3, amplitude: .1, wavelength: 3}]}"},
    // Three boards one behind the other, the middle one sharp.
    {"boards",
     "{lens: {radius: .15, focus: 3}, background: .2, planes: ["
     "{depth: 1.5, x: [-.6, -.42], y: [-.6, .5], radiance: .9, amplitude: .3, wavelength: .3}, "
     "{depth: 3, x: [-.7, .8], y: [-.6, .6], radiance: .7, amplitude: .5, wavelength: .2}, "
     "{depth: 6, x: [-9, 9], y: [-9, 1.6], radiance: .3, amplitude: .2, wavelength: 1.2}]}"},
};

}  // namespace

Interval SceneDescription::range() const {
  Interval out{background, background};
  for (const Plane& p : planes) {
    out.low = std::min(out.low, p.texture.mean - p.texture.amplitude);
    out.high = std::max(out.high, p.texture.mean + p.texture.amplitude);
  }
  return out;
}

SceneDescription read_scene(const Value& given) {
  const Value value = scene_of(given, built_in);
  require_keys(value, "the scene", {"lens", "background", "planes"});
  const Value& planes = required_key(value, "the scene", "planes");
  planes.require(!planes.items().empty(), "planes must be a list of one or more");
  SceneDescription out{.lens = lens(required_key(value, "the scene", "lens"))};
  if (const Value* const background = value.find("background")) {
    out.background = at_least_zero(*background, "the background");
  }
  out.planes = mapped(planes.items(), plane);
  std::ranges::stable_sort(out.planes, {}, &Plane::depth);
  require_apart(out.planes, planes);
  return out;
}

Setting::Setting(SceneDescription scene)
    : scene_(std::move(scene)), rays_(mapped(scene_.planes, [](const Plane& p) -> render::Shape {
        return render::fan({{p.x.low, p.y.low, p.depth},
                            {p.x.high, p.y.low, p.depth},
                            {p.x.high, p.y.high, p.depth},
                            {p.x.low, p.y.high, p.depth}});
      })) {}

const Plane* Setting::first_hit(const PlanePoint& pixel, const PlanePoint& u, Cost& cost) const {
  ++cost.camera_rays;
  const render::Hit hit = rays_.closest_hit(lens_ray(scene_.lens, pixel, u));
  return hit.shape == render::Hit::none ? nullptr : &scene_.planes[hit.shape];
}

}  // namespace assay::depth_of_field
