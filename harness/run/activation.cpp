#include "harness/run/activation.h"

#include <algorithm>
#include <cmath>

#include "estimators/core/flush_denormals.h"
#include "harness/draws/sampler_setup.h"

namespace assay::harness {
namespace {

/// The sampler of that name, or the only one.
const Sampler* sampler_of(const Setup& setup, const std::string& name,
                          std::vector<NamedSampler>& keep) {
  keep = setup.samplers();
  for (const NamedSampler& named : keep) {
    if (named.name == name) return named.sampler.get();
  }
  return keep.size() == 1 ? keep[0].sampler.get() : nullptr;
}

bool same_number(double one, double other) {
  return one == other || (std::isnan(one) && std::isnan(other));
}

/// True if two samplers declare the same at one point.
bool same_at(const Point& point, const Sampler& one, const Sampler& other) {
  return same_number(one.density(point), other.density(point)) &&
         same_number(one.evaluate(point), other.evaluate(point));
}

bool same_draw(const SamplerDraw& one, const SamplerDraw& other) {
  return one.point == other.point && one.density == other.density && one.weight == other.weight &&
         one.lobe == other.lobe && one.valid == other.valid;
}

bool draws_differ(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  const auto& setup = dynamic_cast<const SamplerSetup&>(*subject.setup);
  const Sampler& mine = setup.sampler();
  std::vector<NamedSampler> keep;
  const Sampler* original = sampler_of(*subject.estimator->original, setup.name(), keep);
  if (original == nullptr) return true;
  const FlushDenormals flush;
  for (std::uint64_t i = 0; i < observations; ++i) {
    Stream one(pool.key(), i);
    Stream other(pool.key(), i);
    const SamplerDraw draw = mine.sample(one);
    if (!same_draw(draw, original->sample(other))) return true;
    if (draw.valid && !same_at(draw.point, mine, *original)) return true;
  }
  return false;
}

void draw(Estimator& estimator, const Pool& pool, std::uint64_t index, std::span<double> out) {
  Stream random(pool.key(), index);
  Cost unused;
  estimator.secondary(random, pool.primaries(), out, unused);
}

bool estimates_differ(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  const Setup& original = *subject.estimator->original;
  const std::vector<Channel> mine = subject.setup->channels();
  const std::vector<Channel> theirs = original.channels();
  if (mine.size() != theirs.size()) return true;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].mean != theirs[i].mean) return true;
  }
  const FlushDenormals flush;
  const std::unique_ptr<Estimator> one = subject.setup->make();
  const std::unique_ptr<Estimator> other = original.make();
  const std::vector<std::vector<double>>& kept = pool.kept()->values;
  std::vector<double> a(mine.size());
  std::vector<double> b(theirs.size());
  for (std::uint64_t i = 0; i < observations; ++i) {
    // One observation, such as an image, may cost as much as the rest of a look.
    if (i >= kept.size()) draw(*one, pool, i, a);
    draw(*other, pool, i, b);
    if (!std::ranges::equal(i < kept.size() ? kept[i] : a, b)) return true;
  }
  return false;
}

}  // namespace

bool was_activated(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  if (!subject.estimator->original) return true;
  return subject.purpose.empty() ? estimates_differ(subject, pool, observations)
                                 : draws_differ(subject, pool, observations);
}

}  // namespace assay::harness
