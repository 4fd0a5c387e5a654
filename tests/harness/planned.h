#pragma once

#include "harness/pilot/pilot.h"
#include "harness/plan/plan.h"
#include "tests/harness/questions.h"
#include "tests/harness/table.h"

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
  prepared.pilots = run_pilots(all, prepared.asked->questions, seed, *threads(1), silence);
  const Primaries primaries =
      choose_primaries(prepared.asked->questions, prepared.place, prepared.pilots);
  for (std::size_t i = 0; i < prepared.place.size(); ++i) {
    prepared.plans.push_back(
        plan_test(prepared.asked->questions[i], prepared.place[i], prepared.pilots, primaries)
            .plan);
  }
  return prepared;
}

/// Tests of the estimators of tests/tables/plans.txt.
inline Prepared plan_text(const std::string& tests, std::uint64_t seed = 1) {
  return prepare_text(sections_of("plans.txt")[0].head + tests, seed);
}

}  // namespace assay::harness
