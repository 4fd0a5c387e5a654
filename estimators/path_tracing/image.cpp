#include "path_tracing/image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/vector.h"

namespace assay::path_tracing {

namespace {

using std::numbers::pi;

Vector3 mirrored(const Vector3& direction, const Vector3& normal) {
  return direction - 2 * dot(direction, normal) * normal;
}

/// A rough surface as seen along a ray; the normal faces the viewer.
class Lobe {
 public:
  Lobe(const Material& material, const Vector3& direction, const Vector3& normal)
      : material_(material), normal_(normal), axis_(mirrored(direction, normal)) {}

  /// bsdf times cosine.
  Rgb value(const Vector3& out) const {
    const double cosine = dot(normal_, out);
    if (!(cosine > 0)) return {};
    if (material_.surface == Surface::diffuse) return cosine / pi * material_.colour;
    return cosine * (material_.exponent + 2) / (2 * pi) * lobe(out) * material_.colour;
  }
  double density(const Vector3& out) const {
    if (material_.surface == Surface::diffuse) return std::max(0.0, dot(normal_, out)) / pi;
    return (material_.exponent + 1) / (2 * pi) * lobe(out);
  }
  Vector3 sample(double u, double v) const {
    const bool is_diffuse = material_.surface == Surface::diffuse;
    const double cosine = is_diffuse ? std::sqrt(u) : std::pow(u, 1 / (material_.exponent + 1));
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return render::Frame::about(is_diffuse ? normal_ : axis_)
        .to_world({sine * std::cos(2 * pi * v), sine * std::sin(2 * pi * v), cosine});
  }

 private:
  double lobe(const Vector3& out) const {
    constexpr double least = 1e-30;  // Below, squares of pixels would leave the range of doubles.
    const double value = std::pow(std::max(0.0, dot(axis_, out)), material_.exponent);
    return value > least ? value : 0;
  }

  const Material& material_;
  Vector3 normal_;
  Vector3 axis_;
};

/// The part of unpolarised light that glass reflects; `ratio` is the index ahead over that behind.
double reflectance(double cosine, double ratio, double schlick) {
  const double squared_sine = (1 - cosine * cosine) / (ratio * ratio);
  if (squared_sine >= 1) return 1;
  const double inner = std::sqrt(1 - squared_sine);
  const double parallel = (ratio * cosine - inner) / (ratio * cosine + inner);
  const double across = (cosine - ratio * inner) / (cosine + ratio * inner);
  const double fresnel = (parallel * parallel + across * across) / 2;
  if (schlick == 0) return fresnel;
  const double least = (ratio - 1) * (ratio - 1) / ((ratio + 1) * (ratio + 1));
  const double approximate = least + (1 - least) * std::pow(1 - cosine, 5);
  return fresnel + schlick * (approximate - fresnel);
}

Vector3 through_glass(const Hit& hit, const Vector3& direction, double schlick, double u) {
  const bool entering = dot(hit.normal, direction) < 0;
  const Vector3 normal = entering ? hit.normal : -hit.normal;
  const double ratio = entering ? hit.material->refraction : 1 / hit.material->refraction;
  const double cosine = -dot(normal, direction);
  if (u < reflectance(cosine, ratio, schlick)) return mirrored(direction, normal);
  const double inner = std::sqrt(1 - (1 - cosine * cosine) / (ratio * ratio));
  return render::normalised(direction / ratio + (cosine / ratio - inner) * normal);
}

bool in_tile(const Picture& picture, std::size_t x, std::size_t y) {
  return x >= picture.width / 2 && x < picture.width / 2 + picture.width / 4 &&
         y >= picture.height / 2 && y < picture.height / 2 + picture.height / 4;
}

}  // namespace

Rgb radiance(const Scene& scene, Integrator integrator, const Defects& defects, Ray ray,
             Stream& random, Cost& cost) {
  // Mirrors and glass could go on for ever.
  constexpr std::size_t most_ideal = 16;
  constexpr std::size_t first_roulette = 2;
  Rgb sum;
  Rgb throughput{1, 1, 1};
  bool ideal = true;   // The last bounce, or the camera, could not have been found from a light.
  double density = 0;  // Of the last bounce.
  std::size_t ideals = 0;
  ++cost.camera_rays;
  for (std::size_t bounce = 0;;) {
    const std::optional<Hit> hit = scene.closest(ray);
    if (!hit) break;
    const Material& material = *hit->material;
    if (material.surface == Surface::emitter) {
      if (dot(hit->normal, ray.direction) >= 0) break;
      double weight = 1;
      if (!ideal && integrator == Integrator::light) weight = 0;
      if (!ideal && integrator == Integrator::multiple) {
        weight = density / (density + scene.light_density(ray.origin, *hit, ray.direction));
        weight += defects.weight * (1 - weight);
      }
      sum += weight * (throughput * material.colour);
      break;
    }
    if (bounce == scene.bounces() || ideals == most_ideal) break;
    if (material.surface == Surface::mirror || material.surface == Surface::glass) {
      const bool mirror = material.surface == Surface::mirror;
      ray = {hit->point,
             mirror ? mirrored(ray.direction, hit->normal)
                    : through_glass(*hit, ray.direction, defects.schlick, random.uniform())};
      if (mirror) throughput = throughput * material.colour;
      ideal = true;
      ++ideals;
      ++cost.closest_hit_rays;
      continue;
    }
    const Vector3 normal = dot(hit->normal, ray.direction) < 0 ? hit->normal : -hit->normal;
    const Lobe lobe(material, ray.direction, normal);
    if (integrator != Integrator::bsdf) {
      const double choice = random.uniform();
      const double u = random.uniform();
      const LightPoint light = scene.sample_light(hit->point, choice, u, random.uniform());
      const Rgb value = lobe.value(light.direction);
      if (light.density > 0 && largest(value) > 0) {
        ++cost.shadow_rays;
        const double least = Scene::offset + defects.shadow_offset;
        if (!scene.occluded({hit->point, light.direction}, light.distance, least)) {
          const double weight =
              integrator == Integrator::multiple
                  ? light.density / (light.density + lobe.density(light.direction))
                  : 1;
          sum += weight / (light.density * (1 + defects.light_density)) *
                 (throughput * (value * light.radiance));
        }
      }
    }
    const double u = random.uniform();
    const Vector3 out = lobe.sample(u, random.uniform());
    density = lobe.density(out);
    const Rgb value = lobe.value(out);
    if (!(density > 0) || !(largest(value) > 0)) break;
    throughput = throughput * value / density;
    if (bounce >= first_roulette) {
      const double survives = std::min(0.95, largest(throughput));
      if (random.uniform() >= survives) break;
      throughput = throughput / std::pow(survives, 1 - defects.roulette);
    }
    ray = {hit->point, out};
    ideal = false;
    ++bounce;
    ++cost.closest_hit_rays;
  }
  if (defects.clamp > 0) {
    for (double& x : sum.values) x = std::min(x, defects.clamp);
  }
  return sum;
}

void render(const Picture& picture, Stream& random, std::uint64_t primaries, std::span<double> out,
            Cost& cost) {
  const Scene::Camera& camera = picture.scene->camera();
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      const std::size_t pixel = y * picture.width + x;
      Stream mine = random.substream(static_cast<std::uint32_t>(pixel));
      const double shift = in_tile(picture, x, y) ? picture.shift : 0;
      Rgb sum;
      for (std::uint64_t i = 0; i < primaries; ++i) {
        const double s =
            (static_cast<double>(x) + shift + mine.uniform()) / static_cast<double>(picture.width);
        const double t =
            (static_cast<double>(y) + mine.uniform()) / static_cast<double>(picture.height);
        const Ray ray{camera.eye,
                      render::normalised(camera.corner + s * camera.right + t * camera.down)};
        sum += radiance(*picture.scene, picture.integrator, picture.defects, ray, mine, cost);
      }
      const bool dead = x == picture.width / 3 && y == picture.height / 2;
      const double scale = (dead ? 1 - picture.dead : 1) / static_cast<double>(primaries);
      std::ranges::copy((scale * sum).values, out.subspan(3 * pixel).begin());
    }
  }
  cost.samples += primaries;
}

Picture read_picture(Parameters& given) {
  return {.scene = scene_of(given.string("scene")),
          .integrator = given.choice<Integrator>("integrator"),
          .width = given.count("width"),
          .height = given.count("height")};
}

std::shared_ptr<const Setup> image_setup(Picture picture) {
  const auto shared = std::make_shared<const Picture>(std::move(picture));
  const ImageShape shape{
      shared->width, shared->height, {render::colours.begin(), render::colours.end()}, true};
  return setup_of(
      {.make = estimating([shared](Stream& random, std::uint64_t primaries, std::span<double> out,
                                   Cost& cost) { render(*shared, random, primaries, out, cost); }),
       .image = shape,
       .elements = {{.low = 0}}});
}

}  // namespace assay::path_tracing

namespace assay::plugins {

std::vector<Entry> path_tracing_image() {
  using namespace path_tracing;
  return {
      {{.name = "path_tracing/image",
        .summary = "A picture by path tracing: a diffuse box, glass, or glossy plates.",
        .description =
            "A primary is an image of one path a pixel, through a uniform point of the pixel. "
            "Scenes: `box` has diffuse walls under a wide light; `glass` a glass sphere and a "
            "mirror under a small one, with rare bright paths; `plates` four glossy plates under "
            "four lights (Veach 1997). Integrators: `light` samples emitters, `bsdf` follows "
            "the surfaces' lobes, `multiple` does both with the balance heuristic. All have one "
            "expectation. Mirrors and glass are followed by each, and emitters seen in them "
            "count. Nothing is known in closed form: compare two of them.",
        .parameters = {text_parameter("scene", "what is rendered", "box",
                                      {"box", "glass", "plates"}),
                       text_parameter("integrator", "how light is found", "multiple",
                                      {"light", "bsdf", "multiple"}),
                       count_parameter("width", "columns of pixels", "32", {4, 4096}),
                       count_parameter("height", "rows of pixels", "24", {4, 4096})}},
       [](Parameters& given) { return image_setup(read_picture(given)); }}};
}

}  // namespace assay::plugins
