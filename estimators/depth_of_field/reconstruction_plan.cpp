#include <algorithm>
#include <cmath>

#include "depth_of_field/image.h"
#include "depth_of_field/reconstruction.h"

namespace assay::depth_of_field {

namespace {

class Reconstruction final : public Estimator {
 public:
  Reconstruction(std::shared_ptr<const ReconstructionPlan> plan, std::size_t worst)
      : plan_(std::move(plan)), worst_(worst), values_(plan_->samples.size()) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      Stream mine = random.substream(static_cast<std::uint32_t>(i));
      values_[i] = lens_average(i, primaries * plan_->counts[i], mine, cost);
    }
    for (std::size_t p = 0; p < plan_->splats.size(); ++p) {
      double sum = 0;
      for (const Share& share : plan_->splats[p]) sum += share.weight * values_[share.sample];
      out[p] = sum;
    }
    out[plan_->splats.size()] = out[worst_];
    cost.camera_rays += primaries * plan_->overhead.camera_rays;
    cost.samples += primaries;
  }

 private:
  double lens_average(std::size_t sample, std::uint64_t count, Stream& random, Cost& cost) const {
    const PlanePoint pixel = plan_->grid.pixel(plan_->pixel_of(plan_->samples[sample]));
    double sum = 0;
    for (std::uint64_t k = 0; k < count; ++k) {
      const double s = random.uniform();
      const PlanePoint u = UniformDisc{}(s, random.uniform());
      sum += plan_->setting->radiance(pixel, u, cost);
    }
    return sum / static_cast<double>(count);
  }

  std::shared_ptr<const ReconstructionPlan> plan_;
  std::size_t worst_;
  std::vector<double> values_;  // scratch
};

std::size_t worst_pixel(const ReconstructionPlan& plan) {
  const std::vector<double> bias = plan.bias();
  const auto larger = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return static_cast<std::size_t>(std::ranges::max_element(bias, larger) - bias.begin());
}

std::vector<Channel> channels_of(const ReconstructionPlan& plan, const ImageShape& shape,
                                 std::size_t worst) {
  std::vector<Channel> out;
  for (std::size_t p = 0; p < plan.exact.size(); ++p) {
    out.push_back(radiance_channel(plan.setting->scene(), plan.exact[p]));
    out.back().name = element_name(shape, p);
    out.back().variance.reset();
  }
  out.push_back(out[worst]);
  out.back().name = "worst";
  out.back().diagnostic = true;
  return out;
}

}  // namespace

ReconstructionPlan read_reconstruction_plan(Parameters& given, const ReconstructionRules& rules) {
  const std::uint64_t spacing = given.count("spacing");
  if (spacing > tile_side || (spacing & (spacing - 1)) != 0) {
    given.refuse("spacing", "must be 0 (by the predicted bandwidth), 1, 2, 4 or 8 pixels");
  }
  ReconstructionPlan plan{.setting = read_setting(given), .grid = read_grid(given)};
  const Prediction found = predict(*plan.setting, plan.grid, rules.prediction);
  plan.overhead = found.cost;
  plan.samples = spacing > 0 ? regular_samples(plan.grid, spacing)
                             : samples_by_bandwidth(plan.grid, found.bandwidth);
  std::vector<double> variances;
  for (const ImageSample& s : plan.samples) variances.push_back(found.variance[plan.pixel_of(s)]);
  plan.counts = lens_counts(variances, {static_cast<double>(given.count("samples"))});
  plan.splats = rules.weights(tents(plan.grid, plan.samples));
  for (std::size_t p = 0; p < plan.grid.pixels(); ++p) {
    plan.exact.push_back(exact_moments(plan.setting->scene(), plan.grid.pixel(p)));
  }
  return plan;
}

std::vector<double> ReconstructionPlan::bias() const {
  std::vector<double> out;
  for (std::size_t p = 0; p < splats.size(); ++p) {
    double sum = -exact[p].mean;
    for (const Share& share : splats[p]) {
      sum += share.weight * exact[pixel_of(samples[share.sample])].mean;
    }
    out.push_back(sum);
  }
  return out;
}

std::shared_ptr<const Setup> prepare_reconstruction(Parameters& given,
                                                    const ReconstructionRules& rules) {
  const auto plan =
      std::make_shared<const ReconstructionPlan>(read_reconstruction_plan(given, rules));
  const std::size_t worst = worst_pixel(*plan);
  const ImageShape shape{plan->grid.width, plan->grid.height, {"radiance"}, false};
  return setup_of({.channels = channels_of(*plan, shape, worst),
                   .make = [plan, worst] { return std::make_unique<Reconstruction>(plan, worst); },
                   .samplers = lens_samplers<>(),
                   .image = shape});
}

}  // namespace assay::depth_of_field
