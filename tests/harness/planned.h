#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/plan.h"
#include "tests/harness/questions.h"
#include "tests/harness/running.h"

namespace assay::harness {

/// A suite piloted and planned as a run does it.
struct Prepared {
  std::unique_ptr<Asked> asked;
  std::vector<FamilyPlace> place;
  Pilots pilots;
  std::vector<Plan> plans;
};

inline Prepared prepare_text(const std::string& text, std::uint64_t seed) {
  Prepared prepared{.asked = ask_text(text, seed)};
  prepared.place = places(prepared.asked->suite, prepared.asked->questions);
  std::vector<const PreparedEstimator*> all;
  for (const auto& [name, estimator] : prepared.asked->estimators) all.push_back(&estimator);
  Silence silence;
  prepared.pilots =
      run_pilots(all, pilot_run_of(prepared.asked->questions, seed, threads(1)), silence);
  const Primaries primaries =
      choose_primaries(prepared.asked->questions, prepared.place, prepared.pilots);
  for (std::size_t i = 0; i < prepared.place.size(); ++i) {
    prepared.plans.push_back(
        plan_test(prepared.asked->questions[i], prepared.place[i], prepared.pilots, primaries));
  }
  return prepared;
}

/// Tests of the plans of these estimators.
inline Prepared plan_text(const std::string& tests, std::uint64_t seed = 1) {
  return prepare_text(R"(suite: plans
estimators:
  normal: {plugin: analytic/normal, mean: 2}
  coin: {plugin: analytic/law, law: bernoulli(0.5), primaries: 1}
  single: {plugin: analytic/normal, mean: 2, primaries: 1}
  uniform: {plugin: analytic/exponential_uniform}
  flat: {plugin: analytic/law, law: 'uniform(0, 1)', primaries: 1}
  heavy: {plugin: analytic/heavy_tail, index: 3}
  heavy-single: {plugin: analytic/heavy_tail, index: 3, primaries: 1}
  heavier-single: {plugin: analytic/heavy_tail, index: 2.2, primaries: 1}
  hemisphere: {plugin: luminaire/hemisphere, scene: triangle}
  dart: {plugin: analytic/dart_throwing, primaries: 1}
  corners: {plugin: virtual_lights/weighted, primaries: 2}
  same-samples: {plugin: correlated/area_same_samples, scene: rectangle, primaries: 16}
  multi: {plugin: direct_light/multi_sample, primaries: 1}
  ratio: {plugin: analytic/ratio, primaries: 4096}
  unseen: {plugin: analytic/rare_spike, probability: 1e-9, height: 1, primaries: 1}
  far: {plugin: analytic/rare_spike, probability: 1e-12, height: 1e6, primaries: 1}
  spike: {plugin: analytic/rare_spike, probability: 0.0001, height: 10, noise: 0.1, primaries: 1}
tests:
)" + tests,
                      seed);
}

}  // namespace assay::harness
