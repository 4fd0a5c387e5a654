// Pictures of a scene by path tracing.
//
// A pixel is the mean of paths through uniform points of it. A path's expectation is the integral
// of L over the pixel, with at most so many bounces as the scene allows. Light sampling, bsdf
// sampling and both together have this one expectation.

#include "path_tracing/image.h"

#include <utility>

namespace assay::path_tracing {
namespace {

const std::vector<std::string> colours{"red", "green", "blue"};

/// The tile that a shift moves.
bool in_tile(const Picture& picture, std::size_t x, std::size_t y) {
  return x >= picture.width / 2 && x < picture.width / 2 + picture.width / 4 &&
         y >= picture.height / 2 && y < picture.height / 2 + picture.height / 4;
}

class PictureEstimator final : public Estimator {
 public:
  explicit PictureEstimator(std::shared_ptr<const Picture> picture)
      : picture_(std::move(picture)) {}
  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    render(*picture_, random, primaries, out, cost);
  }

 private:
  std::shared_ptr<const Picture> picture_;
};

}  // namespace

void render(const Picture& picture, Stream& random, std::uint64_t primaries, std::span<double> out,
            Cost& cost) {
  const Scene::Camera& camera = picture.scene->camera();
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      const std::size_t pixel = y * picture.width + x;
      Stream mine = random.substream(static_cast<std::uint32_t>(pixel));
      const double shift = in_tile(picture, x, y) ? picture.shift : 0;
      Colour sum;
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
      out[3 * pixel] = scale * sum.x;
      out[3 * pixel + 1] = scale * sum.y;
      out[3 * pixel + 2] = scale * sum.z;
    }
  }
  cost.samples += primaries;
}

Information image_information() {
  return {.name = "path_tracing/image",
          .summary = "A picture by path tracing: a diffuse box, glass, or glossy plates.",
          .description =
              "A primary is an image of one path a pixel, through a uniform point of the pixel. "
              "Scenes: `box` has diffuse walls under a wide light; `glass` a glass sphere and a "
              "mirror under a small one, with rare bright paths; `plates` four glossy plates under "
              "four lights (Veach 1997). Integrators: `light` samples emitters, `bsdf` follows "
              "the surfaces' lobes, `multiple` does both with the balance heuristic. All have one "
              "expectation. Mirrors and glass are followed by each, and emitters seen in them "
              "count. Nothing is known in closed form: compare two of them.",
          .parameters = {{.name = "scene",
                          .type = ParameterType::string,
                          .summary = "what is rendered",
                          .fallback = "box",
                          .choices = scene_names()},
                         {.name = "integrator",
                          .type = ParameterType::string,
                          .summary = "how light is found",
                          .fallback = "multiple",
                          .choices = integrator_names()},
                         {.name = "width",
                          .type = ParameterType::count,
                          .summary = "columns of pixels",
                          .fallback = "32",
                          .low = 4,
                          .high = 4096},
                         {.name = "height",
                          .type = ParameterType::count,
                          .summary = "rows of pixels",
                          .fallback = "24",
                          .low = 4,
                          .high = 4096}}};
}

Picture read_picture(Parameters& given) {
  return {.scene = scene_of(given.string("scene")),
          .integrator = integrator_of(given.string("integrator")),
          .width = given.count("width"),
          .height = given.count("height")};
}

std::shared_ptr<const Setup> image_setup(Picture picture) {
  const auto shared = std::make_shared<const Picture>(std::move(picture));
  const ImageShape shape{shared->width, shared->height, colours, true};
  return setup_of({.channels = element_channels(shape, {.low = 0}),
                   .make = [shared] { return std::make_unique<PictureEstimator>(shared); },
                   .image = shape});
}

}  // namespace assay::path_tracing

namespace assay::plugins {

std::vector<Entry> path_tracing_image() {
  using namespace path_tracing;
  return {
      {image_information(), [](Parameters& given) { return image_setup(read_picture(given)); }}};
}

}  // namespace assay::plugins
