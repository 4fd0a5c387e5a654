#include "harness/pilot/pilot_run.h"

#include <algorithm>

#include "harness/theta/method.h"
#include "harness/theta/methods.h"

namespace assay::harness {
namespace {

/// Estimators whose costs some claim is about.
std::set<std::string> costly(const std::vector<Question>& questions) {
  std::set<std::string> names;
  for (const Question& question : questions) {
    if (methods_for(question).front().keeps != Keeps::costs) continue;
    for (const Subject& subject : question.subjects) names.insert(subject.estimator->name);
  }
  return names;
}

}  // namespace

std::vector<const Subject*> piloted_draws(const Question& question) {
  std::vector<const Subject*> draws;
  if (!question.is().pilots_draws) return draws;
  for (const Subject& side : question.subjects) {
    if (!side.purpose.empty()) draws.push_back(&side);
  }
  return draws;
}

PilotRun pilot_run_of(const std::vector<Question>& questions, const std::vector<bool>& chosen,
                      std::uint64_t seed, unsigned threads) {
  PilotRun run{.seed = seed, .threads = threads, .with_cost = costly(questions)};
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (!chosen[i]) continue;
    for (const Subject* subject : piloted_draws(questions[i])) run.draws.push_back(subject);
  }
  return run;
}

PilotRun pilot_run_of(const std::vector<Question>& questions, std::uint64_t seed,
                      unsigned threads) {
  return pilot_run_of(questions, std::vector<bool>(questions.size(), true), seed, threads);
}

}  // namespace assay::harness
