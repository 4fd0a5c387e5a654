#include "estimators/sampler.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace assay {

namespace {

double first(const Point& p) { return p[0]; }
double second(const Point& p) { return p[1]; }

// acos(z) loses half the digits near the poles; atan2 of the two legs does not.
double theta(const Point& p) { return std::atan2(std::hypot(p[0], p[1]), p[2]); }

double phi(const Point& p) {
  const double angle = std::atan2(p[1], p[0]);
  // A tiny negative angle plus 2 pi rounds to 2 pi itself, which is not in [0, 2 pi).
  const double turned = angle < 0 ? angle + 2 * std::numbers::pi : angle;
  return turned < 2 * std::numbers::pi ? turned : 0;
}

std::vector<Marginal> directions(double highest_theta) {
  return {{"theta", 0, highest_theta, theta}, {"phi", 0, 2 * std::numbers::pi, phi}};
}

/// Writes numbers up to the first that throws, and returns how many. Throws if that is the first.
std::size_t each(auto in, auto out, auto number) {
  for (std::size_t i = 0; i < in.size(); ++i) {
    try {
      out[i] = number(in[i]);
    } catch (...) {
      if (i == 0) throw;
      return i;
    }
  }
  return in.size();
}

class SamplerOfParts final : public Sampler {
 public:
  explicit SamplerOfParts(SamplerParts parts) : parts_(std::move(parts)) {}

  Domain domain() const override { return parts_.domain; }
  std::array<double, 2> bounds() const override { return parts_.bounds; }
  SamplerDraw sample(Stream& random) const override {
    const std::optional<Point> point = parts_.point(random);
    if (!point) return {.valid = false};
    const double declared = density(*point);
    if (!parts_.evaluate) return {.point = *point, .density = declared, .weight = 1};
    const double value = parts_.evaluate(*point);
    return {.point = *point, .density = declared, .weight = value == 0 ? 0 : value / declared};
  }
  double density(const Point& point) const override { return parts_.density(point); }
  double evaluate(const Point& point) const override {
    return parts_.evaluate ? parts_.evaluate(point) : density(point);
  }
  Panels panels() const override { return parts_.panels; }

 private:
  SamplerParts parts_;
};

}  // namespace

std::shared_ptr<const Sampler> sampler_of(SamplerParts parts) {
  return std::make_shared<SamplerOfParts>(std::move(parts));
}

std::size_t Sampler::samples(std::span<const Stream> random, std::span<SamplerDraw> draws) const {
  return each(random, draws, [this](Stream stream) { return sample(stream); });
}

std::size_t Sampler::densities(std::span<const Point> points, std::span<double> out) const {
  return each(points, out, [this](const Point& point) { return density(point); });
}

std::size_t Sampler::lobe_densities(int lobe, std::span<const Point> points,
                                    std::span<double> out) const {
  if (lobes() == 1) return densities(points, out);
  return each(points, out, [&](const Point& point) { return lobe_density(lobe, point); });
}

std::size_t Sampler::evaluations(std::span<const Point> points, std::span<double> out) const {
  return each(points, out, [this](const Point& point) { return evaluate(point); });
}

std::vector<Marginal> marginals(Domain domain) {
  switch (domain) {
    case Domain::interval:
      return {{"x", 0, 1, first}};
    case Domain::square:
    case Domain::triangle:
      return {{"u", 0, 1, first}, {"v", 0, 1, second}};
    case Domain::hemisphere:
      return directions(std::numbers::pi / 2);
    case Domain::sphere:
      return directions(std::numbers::pi);
  }
  return {};
}

}  // namespace assay
