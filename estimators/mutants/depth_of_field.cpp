// Mutants of depth of field: lenses, counts, predictions or splats with one thing wrong.

#include <algorithm>
#include <utility>

#include "depth_of_field/image.h"
#include "depth_of_field/pixel.h"
#include "depth_of_field/reconstruction.h"
#include "estimators/mutant.h"

namespace assay::plugins {

namespace {

using namespace depth_of_field;

struct CrowdedDisc {
  PlanePoint operator()(double s, double t) const { return UniformDisc{}(s * s, t); }
};

// Moves lens points in by focus / depth of the surface that the middle of the lens sees. Discs of
// confusion then have the radius A |depth - focus| / depth.
std::shared_ptr<const Setup> blur_by_depth(Parameters& given) {
  const SharedSetting setting = read_setting(given);
  const PlanePoint pixel = read_pixel(given);
  given.require(given.count("jitter") == 1, "jitter", "must be 1 here");
  const Plane* const seen = setting->first_hit(pixel, {}, Uncounted());
  const double factor = seen ? setting->scene().lens.focus / seen->depth : 1;
  given.require(factor <= 1, "scene",
                "what the middle of the lens sees must not be in front of the focal plane");
  Channel channel = radiance_channel(setting->scene(), exact_moments(setting->scene(), pixel));
  channel.variance.reset();
  return averaging(std::move(channel), [setting, pixel, factor](Stream& random, Cost& cost) {
    const PlanePoint u = lens_point(random);
    return setting->radiance(pixel, {factor * u.x, factor * u.y}, cost);
  });
}

struct PilotReused {
  template <class Draw>
  double operator()(const StageRule& rule, const Draw& draw) const {
    RunningMoments all;
    for (std::uint64_t i = 0; i < rule.pilot; ++i) all.add(draw());
    for (const double n = rule.count(all.variance()); all.count() < n;) all.add(draw());
    return all.mean();
  }
};

struct StoppedByItsError {
  template <class Draw>
  double operator()(const StageRule& rule, const Draw& draw) const {
    RunningMoments all;
    for (std::uint64_t i = 0; i < rule.pilot; ++i) all.add(draw());
    while (all.count() < rule.count(all.variance())) all.add(draw());
    return all.mean();
  }
};

struct DividedByTheMean : SoundShading {
  double mean;
  double divisor(const ImagePlan&, std::size_t) const { return mean; }
};

std::shared_ptr<const Setup> divided_by_the_mean(Parameters& given) {
  ImagePlan plan = read_image_plan(given);
  double sum = 0;
  for (const std::uint64_t n : plan.counts) sum += static_cast<double>(n);
  DividedByTheMean shading;
  shading.mean = sum / static_cast<double>(plan.counts.size());
  return image_setup(std::move(plan), shading);
}

struct SharpBackground : SoundShading {
  double sample(const ImagePlan& plan, std::size_t pixel, Stream& random, Cost& cost) const {
    if (!plan.background[pixel]) return SoundShading::sample(plan, pixel, random, cost);
    return plan.setting->radiance(plan.grid.pixel(pixel), {}, cost);
  }
};

// The largest frequency with its sign: -Wv / f made it positive, Wv itself is not.
double signed_bandwidth(std::span<const CameraFrequency> waves, const Lens& lens) {
  double highest = 0;
  for (const CameraFrequency& w : waves) {
    if (passes(w, lens)) highest = std::max(highest, -w.image);
  }
  return highest;
}

}  // namespace

std::vector<Entry> mutants_depth_of_field() {
  return {
      mutant({"lens_crowded", "depth_of_field/pixel",
              "draws lens points with a radius in proportion to a random number, not to its root: "
              "too many near the middle; +9 % where a segment of the disc is lit at d / r = 1/2, "
              "and its sampler shows it."},
             prepare_pixel<CrowdedDisc>),
      mutant(
          {"lens_blur_by_depth", "depth_of_field/pixel",
           "has discs of confusion of radius A |depth - focus| / depth, divided by the depth and "
           "not by the focus: too small behind the focal plane; +42 % at the crest of `sinusoid`."},
          blur_by_depth),
      mutant({"lens_pilot_reused", "depth_of_field/two_stage",
              "averages the pilot with the samples that it asks for: too few follow a pilot that "
              "saw nothing; too dark where a small part of the lens is lit."},
             prepare_two_stage<PilotReused>),
      mutant({"lens_stopped_by_error", "depth_of_field/two_stage",
              "draws until the samples' own estimate of their error is small enough: stops too "
              "early where it has seen nothing; too dark where a small part of the lens is lit."},
             prepare_two_stage<StoppedByItsError>),
      mutant(
          {"lens_divided_by_mean", "depth_of_field/image",
           "divides each pixel's sum by the mean number of lens samples, not by the pixel's: "
           "too bright by its share of samples where there is variance, dark where there is none."},
          divided_by_the_mean),
      mutant({"lens_sharp_background", "depth_of_field/image",
              "gives the lens no aperture in pixels whose middle sees no surface: what is blurred "
              "across the background there is cut off."},
             [](Parameters& given) {
               const PredictionRules rules =
                   given.string("prediction") == "covariance" ? covariance_rules() : wave_rules();
               return image_setup(read_image_plan(given, &rules), SharpBackground{});
             }),
      mutant({"lens_fronts_ignored", "depth_of_field/image",
              "predicts nothing from occluders in front of the focal plane: no bias, but one lens "
              "sample where there is most noise."},
             [](Parameters& given) {
               PredictionRules rules = wave_rules();
               rules.occludes = [](const Plane& front, const Lens& lens) {
                 return front.depth >= lens.focus;
               };
               return image_setup(read_image_plan(given, &rules));
             }),
      mutant({"bandwidth_signed", "depth_of_field/reconstruction",
              "takes the largest frequency with its sign: those that are all negative count as "
              "none, and waves are sampled eight pixels apart."},
             [](Parameters& given) {
               ReconstructionRules rules;
               rules.prediction.bandwidth = signed_bandwidth;
               return prepare_reconstruction(given, rules);
             }),
      mutant(
          {"splats_unnormalised", "depth_of_field/reconstruction",
           "does not divide by the sum of the weights: too bright where dense samples and sparse "
           "ones meet, too dark beyond the last sample."},
          [](Parameters& given) {
            return prepare_reconstruction(
                given, {.weights = [](Splats as_they_fall) { return as_they_fall; }});
          }),
  };
}

}  // namespace assay::plugins
