#include "brdf/albedo.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "render/brdf/brdf_integrals.h"
#include "render/rejection.h"

namespace assay::brdf {

namespace {

using render::Target;
using render::Vector3;

Vector3 vector(const Point& p) { return {p[0], p[1], p[2]}; }
Point point(const Vector3& v) { return {v.x, v.y, v.z}; }

class BrdfSampler : public Sampler {
 public:
  explicit BrdfSampler(SharedBrdf brdf) : brdf_(std::move(brdf)) {}

  Domain domain() const override { return Domain::hemisphere; }
  double evaluate(const Point& p) const override {
    return p[2] > 0 ? brdf_->target(Target::brdf_cosine, vector(p)) : 0;
  }
  // Four standard deviations of the lobe of w_o, twice as wide as that of h, to a part.
  Panels panels() const override {
    const double part = 8 * brdf_->width();
    const auto parts = [&](double range) {
      return static_cast<std::size_t>(std::ceil(range / part));
    };
    return {.first = parts(std::numbers::pi / 2), .second = parts(2 * std::numbers::pi)};
  }

 protected:
  const render::HalfVectorBrdf& brdf() const { return *brdf_; }
  SamplerDraw draw(const Vector3& out) const {
    const Point p = point(out);
    const double p_out = density(p);
    return {.point = p, .density = p_out, .weight = evaluate(p) / p_out};
  }

 private:
  SharedBrdf brdf_;
};

class PublishedSampler final : public BrdfSampler {
 public:
  using BrdfSampler::BrdfSampler;

  SamplerDraw sample(Stream& random) const override {
    const double u = random.uniform();
    const Vector3 out = brdf().reflected(brdf().half_vector(u, random.uniform_open()));
    return out.z > 0 ? draw(out) : SamplerDraw{.valid = false};
  }
  double density(const Point& p) const override { return brdf().density(vector(p)); }
};

class RejectionSampler final : public BrdfSampler {
 public:
  /// `integral` of the target over the upper hemisphere.
  RejectionSampler(SharedBrdf brdf, Target target, double integral)
      : BrdfSampler(std::move(brdf)), target_(target), integral_(integral) {}

  SamplerDraw sample(Stream& random) const override {
    return draw(render::sample_by_rejection(brdf(), target_, random));
  }
  double density(const Point& p) const override {
    return p[2] > 0 ? brdf().target(target_, vector(p)) / integral_ : 0;
  }

 private:
  Target target_;
  double integral_;
};

struct Prepared {
  Channel channel;
  std::shared_ptr<const Sampler> sampler;
};

Channel channel(const render::BrdfIntegrals& integrals, double second_moment, double bound) {
  const double mean = integrals.albedo;
  return {.name = "albedo",
          .mean = mean,
          .mean_error = mean * integrals.error,
          .variance = second_moment - mean * mean,
          .low = 0,
          .high = bound};
}

// f cos_o / (p / mass) <= mass times the bound of f cos_o / p.
Prepared by_density(SharedBrdf brdf, const render::BrdfIntegrals& i) {
  return {channel(i, i.mass * i.second_moment, i.mass * brdf->weight_bound()),
          std::make_shared<RejectionSampler>(brdf, Target::density, i.mass)};
}

// f cos_o / (f / B) = B cos_o <= B, of second moment B^2 E[cos_o^2] = B times that of f.
Prepared by_brdf(SharedBrdf brdf, const render::BrdfIntegrals& i) {
  return {channel(i, i.brdf * i.cosine_moment, i.brdf),
          std::make_shared<RejectionSampler>(brdf, Target::brdf, i.brdf)};
}

// f cos_o / (f cos_o / albedo): the albedo whatever is drawn, to rounding.
Prepared by_brdf_cosine(SharedBrdf brdf, const render::BrdfIntegrals& i) {
  // A weight is off by a few units in the last place, a sum of many primaries by more.
  const double rounding = i.albedo * 0x1p-40;
  Channel constant = channel(i, i.albedo * i.albedo, i.albedo + rounding);
  constant.low = i.albedo - rounding;
  constant.rounding = 2 * rounding;
  return {constant, std::make_shared<RejectionSampler>(brdf, Target::brdf_cosine, i.albedo)};
}

}  // namespace

std::shared_ptr<const Sampler> published_sampler(SharedBrdf brdf) {
  return std::make_shared<PublishedSampler>(std::move(brdf));
}

Channel published_channel(const render::HalfVectorBrdf& brdf) {
  const render::BrdfIntegrals integrals = integrate(brdf);
  return channel(integrals, integrals.second_moment, brdf.weight_bound());
}

std::shared_ptr<const Setup> albedo(Channel channel, std::shared_ptr<const Sampler> sampler) {
  return averaging(std::move(channel),
                   [sampler](Stream& random) { return sampler->sample(random).weight; },
                   {{"direction", sampler}});
}

std::shared_ptr<const Setup> prepare_albedo(SharedBrdf brdf, Parameters& parameters) {
  const std::string kind = parameters.string("sampler");
  if (kind == "published") return albedo(published_channel(*brdf), published_sampler(brdf));
  const render::BrdfIntegrals integrals = integrate(*brdf);
  Prepared prepared = kind == "density_rejection" ? by_density(brdf, integrals)
                      : kind == "brdf_rejection"  ? by_brdf(brdf, integrals)
                                                  : by_brdf_cosine(brdf, integrals);
  return albedo(std::move(prepared.channel), std::move(prepared.sampler));
}

std::vector<ParameterInformation> incident_parameters() {
  return {{.name = "theta_i",
           .summary = "polar angle of the incident direction",
           .unit = "rad",
           .fallback = "0.8",
           .low = 0,
           .high = 1.5},
          {.name = "phi_i",
           .summary = "azimuth of the incident direction, from the x axis of the lobe",
           .unit = "rad",
           .fallback = "0.5",
           .low = 0,
           .high = 6.283185307179586}};
}

ParameterInformation sampler_parameter() {
  return {.name = "sampler",
          .type = ParameterType::string,
          .summary =
              "how directions are drawn: as published, or by rejection from the published "
              "density above the horizon, from f, or from f cos",
          .fallback = "published",
          .choices = {"published", "density_rejection", "brdf_rejection", "brdf_cosine_rejection"}};
}

}  // namespace assay::brdf
