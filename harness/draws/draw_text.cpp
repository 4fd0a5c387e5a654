#include "harness/draws/draw_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

#include "estimators/core/flush_denormals.h"
#include "harness/draws/sampler_setup.h"

namespace assay::harness {
namespace {

std::size_t coordinates(Domain domain) {
  return domain == Domain::interval ? 1 : has_directions(domain) ? 3 : 2;
}

}  // namespace

std::string draw_text(const Sampler& sampler, StreamKey key, std::uint64_t index) {
  const FlushDenormals flush;
  Stream random(key, index);
  const SamplerDraw draw = draws_of(sampler, std::span(&random, 1)).at(0);
  if (!draw.valid) return fmt::format("no point; weight {}", draw.weight);
  const std::span point = std::span(draw.point).first(coordinates(sampler.domain()));
  std::string text = fmt::format("point ({}); weight {}", fmt::join(point, ", "), draw.weight);
  if (sampler.lobes() > 1) text += fmt::format("; lobe {}", draw.lobe);
  if (sampler.point_mass(draw.lobe) > 0) return text + "; a point mass, which has no density";
  return text + fmt::format("; density {} with the draw, {} at its point; evaluate there {}",
                            draw.density, sampler.density(draw.point),
                            sampler.evaluate(draw.point));
}

}  // namespace assay::harness
