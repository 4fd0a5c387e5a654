#pragma once

// A path-traced picture, and the parts of it that a mutant replaces.

#include "estimators/estimator.h"
#include "path_tracing/tracer.h"

namespace assay::path_tracing {

/// The parts of the film that a mutant replaces.
struct SoundFilm {
  struct Pixel {
    std::size_t x;
    std::size_t y;
  };

  /// The pixel whose square of the scene a pixel shows.
  static Pixel seen(const Pixel& pixel, const ImageShape&) { return pixel; }
  /// A pixel's share of one path.
  static Spectrum recorded(const Spectrum& radiance, const Pixel&, const ImageShape&) {
    return radiance;
  }
};

/// What the parameters say.
struct Picture {
  std::shared_ptr<const Scene> scene;
  Integrator integrator;
  ImageShape shape;
};

Information image_information();
Picture read_picture(Parameters& parameters);

template <class Rules, class Film>
class PictureEstimator final : public Estimator {
 public:
  explicit PictureEstimator(const Picture& picture)
      : tracer_(picture.scene, picture.integrator), shape_(picture.shape) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    for (std::size_t i = 0; i < shape_.pixels(); ++i) {
      const typename Film::Pixel pixel{i % shape_.width, i / shape_.width};
      Stream mine = random.substream(static_cast<std::uint32_t>(i));
      mine.draw_ahead();
      Spectrum sum;
      for (std::uint64_t k = 0; k < primaries; ++k) sum += primary(pixel, mine, cost);
      const Spectrum mean = 1 / static_cast<double>(primaries) * sum;
      out[3 * i] = mean.red;
      out[3 * i + 1] = mean.green;
      out[3 * i + 2] = mean.blue;
    }
    cost.samples += primaries;
  }

 private:
  Spectrum primary(const typename Film::Pixel& pixel, Stream& random, Cost& cost) const {
    const typename Film::Pixel seen = Film::seen(pixel, shape_);
    const double width = static_cast<double>(shape_.width);
    const double height = static_cast<double>(shape_.height);
    const double x = (static_cast<double>(seen.x) + random.uniform()) / width;
    const double y = (static_cast<double>(seen.y) + random.uniform()) / height;
    const Ray ray = tracer_.scene().camera_ray(x, y, width / height);
    return Film::recorded(tracer_.radiance(ray, random, cost), pixel, shape_);
  }

  Tracer<Rules> tracer_;
  ImageShape shape_;
};

template <class Rules, class Film>
class PictureSetup final : public Setup {
 public:
  explicit PictureSetup(Picture picture) : picture_(std::move(picture)) {}

  std::vector<Channel> channels() const override {
    return element_channels(picture_.shape, {.low = 0});
  }
  std::optional<ImageShape> image() const override { return picture_.shape; }
  std::unique_ptr<Estimator> make() const override {
    return std::make_unique<PictureEstimator<Rules, Film>>(picture_);
  }

 private:
  Picture picture_;
};

template <class Rules = SoundRules, class Film = SoundFilm>
std::shared_ptr<const Setup> prepare_picture(Parameters& parameters) {
  return std::make_shared<const PictureSetup<Rules, Film>>(read_picture(parameters));
}

}  // namespace assay::path_tracing
